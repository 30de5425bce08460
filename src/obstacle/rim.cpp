#include "windlass/obstacle/rim.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/obstacle/cylinder.hpp"

namespace windlass::obstacle {

Rim::Rim(double outer_radius, double height, bool above, double tube)
    : radius_(outer_radius), height_(height), up_(above ? 1.0 : -1.0), tube_(tube) {}

Vector2d Rim::beside(const Vector3d& r) const {
  return {r.head<2>().norm() - radius_, up_ * (height_ - r.z()) + tube_};
}

Vector2d Rim::across(const Vector3d& r, const Vector3d& t) const {
  return {r.head<2>().normalized().dot(t.head<2>()), -up_ * t.z()};
}

double Rim::tilt(const Vector3d& r, const Vector3d& t) const {
  const Vector2d way = across(r, t);
  return std::atan(-way(1) / way(0));
}

Rim::Directions Rim::directions(const Vector2d& u) const {
  Directions at;
  at.outward = Cylinder::outward(u(0));
  at.around = Cylinder::around(u(0));
  at.along = std::cos(u(1)) * at.outward + up_ * std::sin(u(1)) * Vector3d::UnitZ();
  return at;
}

double Rim::gap(const Vector3d& r) const {
  const Vector2d from = beside(r);
  if (from.minCoeff() > 0.0) return from.norm() - tube_;
  return from.maxCoeff() - tube_;
}

Vector3d Rim::normal(const Vector3d& r) const {
  const Vector2d from = beside(r);
  const Vector3d outward(r.x(), r.y(), 0.0), down(0.0, 0.0, -up_);
  if (from.minCoeff() > 0.0) return (from(0) * outward.normalized() + from(1) * down).normalized();
  return from(1) >= from(0) ? down : outward.normalized();
}

Matrix3d Rim::hessian(const Vector3d& r) const {
  const Vector2d from = beside(r);
  if (from(0) <= 0.0 && from(1) >= from(0)) return Matrix3d::Zero();
  const Vector3d outward = Vector3d(r.x(), r.y(), 0.0).normalized(), n = normal(r);
  const Vector3d around = Vector3d::UnitZ().cross(outward);
  Matrix3d out = n.dot(outward) / r.head<2>().norm() * around * around.transpose();
  if (from.minCoeff() <= 0.0) return out;
  const Vector3d along = n.cross(around);
  return out + along * along.transpose() / from.norm();
}

Chart Rim::chart(const Vector2d& u) const {
  const Directions at = directions(u);
  Chart out;
  out.r = place(u.cast<long double>()).cast<double>();
  out.tangents << at.around, at.along;
  out.normal = std::sin(u(1)) * at.outward - up_ * std::cos(u(1)) * Vector3d::UnitZ();
  out.bend.setZero();
  out.bend(0, 0) = std::sin(u(1)) / (radius_ + tube_ * std::sin(u(1)));
  if (tube_ > 0.0) out.bend(1, 1) = 1.0 / tube_;
  return out;
}

Vector3d Rim::rise(const Vector2d& u, const Vector2d& step) const {
  const LongVector2 from = u.cast<long double>();
  return (place(from + step.cast<long double>()) - place(from)).cast<double>();
}

LongVector3 Rim::place(const LongVector2& u) const {
  const long double distance = radius_ + tube_ * std::sin(u(1));
  return {distance * std::sin(u(0)), -distance * std::cos(u(0)),
          height_ + up_ * tube_ * (1.0L - std::cos(u(1)))};
}

Vector2d Rim::coordinates(const Vector3d& r, double turn) const {
  const double here = Cylinder::angle(r);
  const Vector2d from = beside(r);
  return {turn + std::remainder(here - turn, 2.0 * M_PI),
          from.isZero(0.0) ? 0.0 : std::atan2(std::max(from(0), 0.0), std::max(from(1), 0.0))};
}

Quaternion Rim::base_frame(const Vector2d& u) const {
  const Chart at = chart(u);
  Matrix3d frame;
  frame << at.normal, -Vector3d(at.normal.cross(Vector3d(at.tangents.col(0)))), at.tangents.col(0);
  const Eigen::Quaterniond q(frame);
  return {q.w(), q.x(), q.y(), q.z()};
}

std::shared_ptr<const Rim> as_rim(const SurfacePointer& surface) {
  return std::dynamic_pointer_cast<const Rim>(surface);
}

}  // namespace windlass::obstacle
