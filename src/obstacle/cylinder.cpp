#include "windlass/obstacle/cylinder.hpp"

#include <cmath>

namespace windlass::obstacle {

double Cylinder::gap(const Vector3d& r) const { return std::hypot(r(0), r(1)) - 1.0; }

Vector3d Cylinder::normal(const Vector3d& r) const {
  return Vector3d(r(0), r(1), 0.0) / std::hypot(r(0), r(1));
}

Matrix3d Cylinder::hessian(const Vector3d& r) const {
  const double distance = std::hypot(r(0), r(1));
  const Vector3d round = Vector3d(-r(1), r(0), 0.0) / distance;
  return round * round.transpose() / distance;
}

Vector3d Cylinder::outward(double a) { return {std::sin(a), -std::cos(a), 0.0}; }
Vector3d Cylinder::around(double a) { return {std::cos(a), std::sin(a), 0.0}; }
double Cylinder::angle(const Vector3d& r) { return std::atan2(r(0), -r(1)); }

Chart Cylinder::chart(const Vector2d& u) const {
  const double s = std::sin(u(0)), c = std::cos(u(0));
  Chart at;
  at.r << s, -c, u(1);
  at.tangents << c, 0.0, s, 0.0, 0.0, 1.0;
  at.normal << s, -c, 0.0;
  at.bend << 1.0, 0.0, 0.0, 0.0;
  return at;
}

Vector3d Cylinder::rise(const Vector2d& u, const Vector2d& step) const {
  const double chord = 2.0 * std::sin(0.5 * step(0)), middle = u(0) + 0.5 * step(0);
  return {chord * std::cos(middle), chord * std::sin(middle), step(1)};
}

LongVector3 Cylinder::place(const LongVector2& u) const { return {std::sin(u(0)), -std::cos(u(0)), u(1)}; }

Vector2d Cylinder::coordinates(const Vector3d& r, double turn) const { return {turn, r(2)}; }

Quaternion Cylinder::base_frame(const Vector2d& u) const {
  // At the south pole d₁ = −e_y, d₂ = −e_z, d₃ = e_x; turned about e_z by u₀.
  const double c = 0.5 * std::cos(0.5 * u(0)), s = 0.5 * std::sin(0.5 * u(0));
  return {-(c + s), c + s, s - c, c - s};
}

const SurfacePointer& unit_cylinder() {
  static const SurfacePointer cylinder = std::make_shared<const Cylinder>();
  return cylinder;
}

}  // namespace windlass::obstacle
