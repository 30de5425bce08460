#pragma once

#include "windlass/obstacle/surface.hpp"

namespace windlass::obstacle {

/// The outer edge of a plate round e_z, as the centre line of a rod of radius a meets it: beyond its circle of radius R the plane
/// in which the centre line touches the plate goes on as a quarter of a torus about the physical edge, a circle for a = 0,
///
///     X(u) = (R + a sin α) e_r(θ) + (z_p + σ a (1 − cos α)) e_z,   N = sin α e_r − σ cos α e_z,   u = (θ, α),  0 <= α <= π/2,
///
/// σ = 1 for a plate above the rod, −1 for one below; α = 0 is the plate's plane, and at α = π/2 its outer side begins. For a = 0 X
/// does not answer to α: there the direction of the force is what tangency says. Its chart is not isometric; the tangents given
/// are of unit size, the coordinates angles.
class Rim final : public Surface {
 public:
  /// @param height  z_p, of the centre line under the plate
  Rim(double outer_radius, double height, bool above, double tube);

  void move_to(double height) { height_ = height; }

  double circle() const { return radius_; }
  double tube() const { return tube_; }
  /// Distance from the physical edge outward, and from the physical plane to the rod's side.
  Vector2d beside(const Vector3d& r) const;
  /// The tangent's part in these two directions.
  Vector2d across(const Vector3d& r, const Vector3d& t) const;
  /// e_r, e_θ at θ, and e_α, the direction in which X moves with α.
  struct Directions {
    Vector3d outward, around, along;
  };
  Directions directions(const Vector2d& u) const;
  /// α of a force normal to the tangent.
  double tilt(const Vector3d& r, const Vector3d& t) const;

  /// From the plate with its outer side, a body: < 0 inside.
  double gap(const Vector3d& r) const override;
  Vector3d normal(const Vector3d& r) const override;
  Matrix3d hessian(const Vector3d& r) const override;
  Chart chart(const Vector2d& u) const override;
  Vector3d rise(const Vector2d& u, const Vector2d& step) const override;
  LongVector3 place(const LongVector2& u) const override;
  Vector2d coordinates(const Vector3d& r, double turn) const override;
  double turn(const Vector2d& u) const override { return u(0); }
  Quaternion base_frame(const Vector2d& u) const override;
  double curvature() const override { return 1.0 / (radius_ + tube_); }
  bool keeps_flat() const override { return false; }
  bool endless_along_x() const override { return false; }

 private:
  double radius_, height_, up_, tube_;
};

/// The same surface as a rim; null: it is another one.
std::shared_ptr<const Rim> as_rim(const SurfacePointer& surface);

}  // namespace windlass::obstacle
