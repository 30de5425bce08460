#include "windlass/contact/rim_joint.hpp"

#include <cmath>

namespace windlass::contact::spatial {

using Eigen::Vector3d;

namespace {

Eigen::Matrix3d directors_at(const double* w) {
  return rod::directors(Eigen::Map<const Eigen::Vector4d>(w + 2));
}

}  // namespace

double RimTouch::slide(const double* w) const {
  return directors_at(w).col(2).dot(rim_->directions(on_surface(w)).around) / distance(w);
}

Attachment RimTouch::attach(Side, const double* w, const Loads&) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  const obstacle::Rim::Directions here = rim_->directions(on_surface(w));
  at.q = Eigen::Map<const Eigen::Vector4d>(w + 2);
  at.dq.rightCols(3).setIdentity();
  at.x = rim_->chart(on_surface(w)).r;
  at.dx.col(0) = distance(w) * here.around;
  at.dx.col(1) = rim_->tube() * here.along;
  if (rim_->tube() > 0.0) return at;
  at.tested = at.dx;
  at.tested->col(1) = here.along;
  return at;
}

void RimTouch::curvature(Side, const double* w, const Loads&, const SmallVector&, const SmallVector& f,
                         SmallMatrix& out) const {
  const obstacle::Rim::Directions here = rim_->directions(on_surface(w));
  const Vector3d force = f, normal = rim_->chart(on_surface(w)).normal;
  const double mixed = std::cos(w[1]) * force.dot(here.around);
  const double scale = rim_->tube() > 0.0 ? rim_->tube() : 1.0;  // of the second equation
  out(0, 0) -= distance(w) * force.dot(here.outward);
  out(0, 1) += rim_->tube() * mixed;
  out(1, 0) += scale * mixed;
  out(1, 1) -= scale * force.dot(normal);
}

Joint::Location RimTouch::location(const double* w, const SmallVector&, const SmallVector&) const {
  const Eigen::Matrix3d d = directors_at(w);
  const obstacle::Rim::Directions here = rim_->directions(on_surface(w));
  const Vector3d normal = rim_->chart(on_surface(w)).normal;
  Location c;
  c.value = d.col(2).dot(normal);
  c.by_w = SmallVector::Zero(tangent());
  c.by_w(0) = std::sin(w[1]) * here.around.dot(d.col(2));
  c.by_w(1) = here.along.dot(d.col(2));
  c.by_w.tail<3>() = 2.0 * Vector3d::UnitZ().cross(d.transpose() * normal);
  return c;
}

void RimTouch::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  Eigen::Map<Eigen::Vector4d>(out + 2) =
      rod::retract(Eigen::Map<const Eigen::Vector4d>(w + 2), Vector3d(dw + 2));
}

void RimTouch::adopt(const Place& place, double* w) const {
  w[0] = rim_->coordinates(place.r, place.angle)(0);
  Eigen::Map<Eigen::Vector4d>{w + 2} = place.q;
  w[1] = rim_->tilt(place.r, directors_at(w).col(2));
}

}  // namespace windlass::contact::spatial
