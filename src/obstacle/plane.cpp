#include "windlass/obstacle/plane.hpp"

#include <cmath>

namespace windlass::obstacle {

Plane::Plane(const Vector3d& normal, double distance, double outer_radius)
    : normal_(-normal.normalized()), distance_(distance), outer_radius_(outer_radius) {
  constexpr double nearly_along = 1e-6;  // e_x then has no projection to speak of
  const auto projected = [&](const Vector3d& e) { return Vector3d(e - normal_.dot(e) * normal_); };
  Vector3d first = projected(Vector3d::UnitX());
  if (first.norm() < nearly_along) first = projected(Vector3d::UnitY());
  axes_.col(0) = first.normalized();
  axes_.col(1) = normal_.cross(Vector3d(axes_.col(0)));
  Matrix3d directors;
  directors << normal_, -axes_.col(1), axes_.col(0);
  const Eigen::Quaterniond q(directors);
  frame_ << q.w(), q.x(), q.y(), q.z();
}

Chart Plane::chart(const Vector2d& u) const {
  Chart at;
  at.r = axes_ * u - distance_ * normal_;
  at.tangents = axes_;
  at.normal = normal_;
  at.bend.setZero();
  return at;
}

LongVector3 Plane::place(const LongVector2& u) const {
  const long double distance = distance_;
  return axes_.cast<long double>() * u - distance * normal_.cast<long double>();
}

double Plane::turn(const Vector2d& u) const {
  const Vector3d r = axes_ * u - distance_ * normal_;
  return std::atan2(r.x(), -r.y());
}

std::vector<Vector3d> Plane::sheet(const Eigen::AlignedBox3d& box) const {
  const Vector2d middle = axes_.transpose() * box.center();
  const double along = 0.5 * box.sizes().maxCoeff(), across = 0.3 * along;
  std::vector<Vector3d> corners;
  for (const Vector2d& corner : {Vector2d(-along, -across), Vector2d(along, -across), Vector2d(along, across),
                                 Vector2d(-along, across)})
    corners.push_back(axes_ * (middle + corner) - distance_ * normal_);
  return corners;
}

}  // namespace windlass::obstacle
