#include <cmath>

#include "windlass/contact/spatial_joints.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector3d;

Vector3d GuidedEnd::along(const Loads& loads) const {
  const double side = arc_ == Side::left ? 1.0 : -1.0;  // the arc that ends here is the right half
  return {side * std::cos(0.5 * loads.angle), std::sin(0.5 * loads.angle), 0.0};
}

std::vector<int> GuidedEnd::out_of_plane() const {
  std::vector<int> out = frame_->out_of_plane();
  for (int& k : out) ++k;
  return out;
}

Attachment GuidedEnd::attach(Side side, const double* w, const Loads& loads) const {
  const Attachment frame = frame_->attach(side, w + 1, loads);
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  at.q = frame.q;
  at.dq.rightCols(frame_->tangent()) = frame.dq;
  const double right = arc_ == Side::left ? 1.0 : -1.0, half = 0.5 * loads.angle;
  const Vector3d outward(right * std::sin(half), -std::cos(half), 0.0), pull = along(loads);
  at.x = Vector3d(loads.guide_offset * outward + w[0] * pull + loads.guide_height * Vector3d::UnitZ());
  at.dx.col(0) = pull;
  return at;
}

void GuidedEnd::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                          const SmallVector& f, SmallMatrix& out) const {
  const int turns = frame_->tangent();
  SmallMatrix bend = SmallMatrix::Zero(turns, turns);
  frame_->curvature(side, w + 1, loads, g_q, f, bend);
  out.bottomRightCorner(turns, turns) += bend;
}

SmallVector GuidedEnd::dead_load(const double*, const Loads& loads) const {
  SmallVector load = SmallVector::Zero(tangent());  // of the potential −T x
  load(0) = -loads.tension;
  return load;
}

void GuidedEnd::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  frame_->retract(w + 1, dw + 1, out + 1);
}

void GuidedEnd::adopt(const Place& place, double* w) const {
  // Of the pull's direction only the right end's heading is known here: along the tangent, which is near it.
  const Vector3d t = rod::directors(place.q).col(2), outward = (arc_ == Side::left ? 1.0 : -1.0) * t;
  w[0] = outward.dot(place.r);
  frame_->adopt(place, w + 1);
}

}  // namespace windlass::contact::spatial
