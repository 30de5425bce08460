#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "windlass/bvp/lagrangian.hpp"

namespace windlass::rod {

/// Kirchhoff rod lying on the unit cylinder (ρ = 1), isotropic and naturally straight.
///
/// Written on the surface: angle a, height z, inclination ψ, twist χ of the material frame against the Darboux frame
/// (d1 = outward normal). The constraint holds identically:
///
///     a' = cos ψ,  z' = sin ψ,  κ_g = ψ',  κ_n = cos²ψ,  u₃ = χ' + sin ψ cos ψ,
///     L = ½ B (ψ'² + cos⁴ψ) + ½ C (χ' + sin ψ cos ψ)² − n_a cos ψ − n_z sin ψ.
///
/// a and z are cyclic (frictionless): their momenta n_a [EI/ρ] and n_z [EI/ρ²] are constant on the arc.
struct SurfaceDensity {
  using Configuration = bvp::Coordinates<2>;
  static constexpr int ambient = 2, forces = 2;
  using Vector2 = Eigen::Vector2d;
  using Vector4 = Eigen::Vector4d;

  double bending_stiffness = 1.0;       ///< B [EI]
  double twisting_stiffness = 2.0 / 3;  ///< C [EI]

  Vector2 direction(const Vector2& q) const { return {std::cos(q(0)), std::sin(q(0))}; }
  double twist(const Vector2& q, const Vector2& slope) const {
    return slope(1) + std::sin(q(0)) * std::cos(q(0));
  }
  double elastic(const Vector2& q, const Vector2& slope) const {
    const double c = std::cos(q(0)), w = twist(q, slope);
    return 0.5 * bending_stiffness * (slope(0) * slope(0) + c * c * c * c) + 0.5 * twisting_stiffness * w * w;
  }
  double first(const Vector2& q, const Vector2& slope, const Vector2& n, Vector4& gz, Vector2& d) const {
    d = direction(q);
    const double c = d(0), s = d(1), moment = twisting_stiffness * twist(q, slope);
    gz << -2.0 * bending_stiffness * c * c * c * s + moment * (c * c - s * s) + n(0) * s - n(1) * c, 0.0,
        bending_stiffness * slope(0), moment;
    return elastic(q, slope) - n.dot(d);
  }
  void second(const Vector2& q, const Vector2& slope, const Vector2& n, Vector4& gz, Eigen::Matrix4d& hz,
              Vector2& d, Eigen::Matrix2d& dd) const {
    first(q, slope, n, gz, d);
    const double c = d(0), s = d(1), moment = gz(3), cos2 = c * c - s * s;
    hz.setZero();
    hz(0, 0) = 2.0 * bending_stiffness * c * c * (3.0 * s * s - c * c) + twisting_stiffness * cos2 * cos2 -
               4.0 * moment * s * c + n.dot(d);
    hz(0, 3) = hz(3, 0) = twisting_stiffness * cos2;
    hz(2, 2) = bending_stiffness;
    hz(3, 3) = twisting_stiffness;
    dd << -s, 0.0, c, 0.0;
  }
};

}  // namespace windlass::rod

extern template class windlass::bvp::LagrangianOf<windlass::rod::SurfaceDensity>;
