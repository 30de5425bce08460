#include <cmath>

#include "windlass/contact/plate_joints.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<int> EndOnPlate::out_of_plane() const {
  std::vector<int> out = frame_->out_of_plane();
  for (int& k : out) k += 2;
  return out;
}

Attachment EndOnPlate::attach(Side side, const double* w, const Loads& loads) const {
  const Attachment frame = frame_->attach(side, w + 2, loads);
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  at.q = frame.q;
  at.dq.rightCols(frame_->tangent()) = frame.dq;
  at.x = Vector3d(w[0], w[1], plate_->chart(Vector2d::Zero()).r.z());
  at.dx(0, 0) = at.dx(1, 1) = 1.0;
  return at;
}

void EndOnPlate::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                           const SmallVector& f, SmallMatrix& out) const {
  const int turns = frame_->tangent();
  SmallMatrix bend = SmallMatrix::Zero(turns, turns);
  frame_->curvature(side, w + 2, loads, g_q, f, bend);
  out.bottomRightCorner(turns, turns) += bend;
}

SmallVector EndOnPlate::dead_load(const double*, const Loads& loads) const {
  const double outward = arc_ == Side::left ? 1.0 : -1.0;  // the arc that ends here is the right half
  SmallVector load = SmallVector::Zero(tangent());         // of the potential −T·X
  load(0) = -loads.tension * outward * std::cos(0.5 * loads.angle);
  load(1) = -loads.tension * std::sin(0.5 * loads.angle);
  return load;
}

void EndOnPlate::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  frame_->retract(w + 2, dw + 2, out + 2);
}

void EndOnPlate::adopt(const Place& place, double* w) const {
  w[0] = place.r.x();
  w[1] = place.r.y();
  frame_->adopt(place, w + 2);
}

}  // namespace windlass::contact::spatial
