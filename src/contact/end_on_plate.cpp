#include <cmath>

#include "windlass/contact/plate_joints.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector2d;
using Eigen::Vector3d;

Attachment EndOnPlate::attach(Side side, const double* w, const Loads& loads) const {
  Attachment at = attached_frame(side, w, loads);
  at.x = Vector3d(w[0], w[1], plate_->chart(Vector2d::Zero()).r.z());
  at.dx(0, 0) = at.dx(1, 1) = 1.0;
  return at;
}

SmallVector EndOnPlate::dead_load(const double*, const Loads& loads) const {
  SmallVector load = SmallVector::Zero(tangent());  // of the potential −T·X
  load(0) = -loads.tension * outward() * std::cos(0.5 * loads.angle);
  load(1) = -loads.tension * std::sin(0.5 * loads.angle);
  return load;
}

void EndOnPlate::adopt(const Place& place, double* w) const {
  w[0] = place.r.x();
  w[1] = place.r.y();
  adopt_frame(place, w);
}

}  // namespace windlass::contact::spatial
