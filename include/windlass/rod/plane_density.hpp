#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "windlass/bvp/lagrangian.hpp"

namespace windlass::rod {

/// Kirchhoff rod lying on a plane, of any section and natural shape.
///
/// Place (u₀, u₁), inclination ψ of the tangent to u₀, twist χ of the material frame against (N, t×N, t). A plane has no
/// normal curvature and no torsion along any direction:
///
///     u₀' = cos ψ,  u₁' = sin ψ,  strains (ψ' cos χ, −ψ' sin χ, χ'),
///     L = ½ Σ K_i (u_i − û_i)² − n₀ cos ψ − n₁ sin ψ.
///
/// u₀ and u₁ are cyclic: the force's components n₀, n₁ in the plane [EI/ρ²] are constant on the arc.
struct PlaneDensity {
  using Configuration = bvp::Coordinates<2>;
  static constexpr int ambient = 2, forces = 2;
  using Vector2 = Eigen::Vector2d;
  using Vector4 = Eigen::Vector4d;

  Eigen::Vector3d stiffness = {1.0, 1.0, 2.0 / 3.0};  ///< K = (EI1, EI2, GJ) [EI]
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();  ///< û [1/ρ]

  Vector2 direction(const Vector2& q) const { return {std::cos(q(0)), std::sin(q(0))}; }
  Eigen::Vector3d strain(const Vector2& q, const Vector2& slope) const {
    return {slope(0) * std::cos(q(1)) - natural(0), -slope(0) * std::sin(q(1)) - natural(1),
            slope(1) - natural(2)};
  }
  double elastic(const Vector2& q, const Vector2& slope) const {
    const Eigen::Vector3d e = strain(q, slope);
    return 0.5 * e.dot(stiffness.cwiseProduct(e));
  }
  double first(const Vector2& q, const Vector2& slope, const Vector2& n, Vector4& gz, Vector2& d) const {
    d = direction(q);
    const double c = std::cos(q(1)), s = std::sin(q(1));
    const Eigen::Vector3d e = strain(q, slope), m = stiffness.cwiseProduct(e);
    gz << n(0) * d(1) - n(1) * d(0), -slope(0) * (m(0) * s + m(1) * c), m(0) * c - m(1) * s, m(2);
    return 0.5 * m.dot(e) - n.dot(d);
  }
  void second(const Vector2& q, const Vector2& slope, const Vector2& n, Vector4& gz, Eigen::Matrix4d& hz,
              Vector2& d, Eigen::Matrix2d& dd) const {
    first(q, slope, n, gz, d);
    const double c = std::cos(q(1)), s = std::sin(q(1)), rate = slope(0), k1 = stiffness(0),
                 k2 = stiffness(1);
    const Eigen::Vector3d m = stiffness.cwiseProduct(strain(q, slope));
    hz.setZero();
    hz(0, 0) = n.dot(d);
    hz(1, 1) = rate * rate * (k1 * s * s + k2 * c * c) - rate * (m(0) * c - m(1) * s);
    hz(1, 2) = hz(2, 1) = rate * s * c * (k2 - k1) - m(0) * s - m(1) * c;
    hz(2, 2) = k1 * c * c + k2 * s * s;
    hz(3, 3) = stiffness(2);
    dd << -d(1), 0.0, d(0), 0.0;
  }
};

}  // namespace windlass::rod

extern template class windlass::bvp::LagrangianOf<windlass::rod::PlaneDensity>;
