#pragma once

#include "windlass/obstacle/surface.hpp"

namespace windlass::obstacle {

/// A plane wall: the rod stays where n·r <= distance,
///
///     gap = distance − n·r,   N = −n,   X(u) = distance n + u₀ e₀ + u₁ e₁,
///
/// e₀ along the projection of e_x (of e_y where n lies along e_x), e₁ = N × e₀.
class Plane final : public Surface {
 public:
  /// @param normal  n, of any length but zero; `distance` is along its direction [ρ]
  /// @param outer_radius  of a plate round e_z, whose edge is an obstacle of its own (Rim)
  Plane(const Vector3d& normal, double distance,
        double outer_radius = std::numeric_limits<double>::infinity());
  double outer_radius() const override { return outer_radius_; }
  /// Where it is from now on, for all that stands beside it: see MovingPlate.
  void move_to(double distance) { distance_ = distance; }
  double gap(const Vector3d& r) const override { return distance_ + normal_.dot(r); }
  Vector3d normal(const Vector3d&) const override { return normal_; }
  Matrix3d hessian(const Vector3d&) const override { return Matrix3d::Zero(); }
  Chart chart(const Vector2d& u) const override;
  Vector3d rise(const Vector2d&, const Vector2d& step) const override { return axes_ * step; }
  LongVector3 place(const LongVector2& u) const override;
  Vector2d coordinates(const Vector3d& r, double) const override { return axes_.transpose() * r; }
  double turn(const Vector2d& u) const override;
  Quaternion base_frame(const Vector2d&) const override { return frame_; }
  double curvature() const override { return 0.0; }
  bool keeps_flat() const override { return normal_.z() == 0.0; }
  bool endless_along_x() const override { return normal_.x() == 0.0; }
  std::vector<Vector3d> sheet(const Eigen::AlignedBox3d& box) const override;

 private:
  Vector3d normal_;  ///< N = −n
  double distance_, outer_radius_;
  Eigen::Matrix<double, 3, 2> axes_;
  Quaternion frame_;
};

}  // namespace windlass::obstacle
