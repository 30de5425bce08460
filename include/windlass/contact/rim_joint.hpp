#pragma once

#include "windlass/contact/spatial_joints.hpp"
#include "windlass/obstacle/rim.hpp"

namespace windlass::contact::spatial {

/// A touch of a plate's outer edge, see obstacle::Rim: w = (θ, α, q), the place on the circle, the tilt of the force and the frame, 5
/// degrees of freedom, arclength unknown. Equations 6: the force has no part along the edge nor along ∂N/∂α, moments (3), and
/// tangency N·d₃ = 0, which is an equation for α where the rod has no thickness: it passes the edge at an angle, and H goes on
/// through it. Balance across is then tested with a displacement ∂N/∂α that the rod does not have. In variations α has the
/// place of the negative direction that the arclength of other touches is: past an edge the rod may slide.
class RimTouch final : public Joint {
 public:
  explicit RimTouch(std::shared_ptr<const obstacle::Rim> rim) : rim_(std::move(rim)) {}
  JointKind kind() const override { return JointKind::touch; }
  int ambient() const override { return 6; }
  int tangent() const override { return 5; }
  bool locates() const override { return true; }
  int spin_coordinate() const override { return 4; }
  double slide(const double* w) const override;
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return rim_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }

 private:
  double distance(const double* w) const { return rim_->circle() + rim_->tube() * std::sin(w[1]); }
  std::shared_ptr<const obstacle::Rim> rim_;
};

}  // namespace windlass::contact::spatial
