#include <cmath>

#include "windlass/contact/spatial_joints.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector3d;

std::vector<int> PlacedEnd::out_of_plane() const {
  std::vector<int> out = frame_->out_of_plane();
  for (int& k : out) k += places_;
  return out;
}

Attachment PlacedEnd::attached_frame(Side side, const double* w, const Loads& loads) const {
  const Attachment frame = frame_->attach(side, w + places_, loads);
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  at.q = frame.q;
  at.dq.rightCols(frame_->tangent()) = frame.dq;
  return at;
}

void PlacedEnd::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                          const SmallVector& f, SmallMatrix& out) const {
  const int turns = frame_->tangent();
  SmallMatrix bend = SmallMatrix::Zero(turns, turns);
  frame_->curvature(side, w + places_, loads, g_q, f, bend);
  out.bottomRightCorner(turns, turns) += bend;
}

void PlacedEnd::retract(const double* w, const double* dw, double* out) const {
  for (int k = 0; k < places_; ++k) out[k] = w[k] + dw[k];
  frame_->retract(w + places_, dw + places_, out + places_);
}

Vector3d GuidedEnd::along(const Loads& loads) const {
  return {outward() * std::cos(0.5 * loads.angle), std::sin(0.5 * loads.angle), 0.0};
}

Attachment GuidedEnd::attach(Side side, const double* w, const Loads& loads) const {
  Attachment at = attached_frame(side, w, loads);
  const double half = 0.5 * loads.angle;
  const Vector3d across(outward() * std::sin(half), -std::cos(half), 0.0), pull = along(loads);
  at.x = Vector3d(loads.guide_offset * across + w[0] * pull + loads.guide_height * Vector3d::UnitZ());
  at.dx.col(0) = pull;
  return at;
}

SmallVector GuidedEnd::dead_load(const double*, const Loads& loads) const {
  SmallVector load = SmallVector::Zero(tangent());  // of the potential −T x
  load(0) = -loads.tension;
  return load;
}

void GuidedEnd::adopt(const Place& place, double* w) const {
  // Of the pull's direction only the right end's heading is known here: along the tangent, which is near it.
  const Vector3d t = rod::directors(place.q).col(2), away = outward() * t;
  w[0] = away.dot(place.r);
  adopt_frame(place, w);
}

}  // namespace windlass::contact::spatial
