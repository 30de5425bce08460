#pragma once

#include "windlass/bvp/lagrangian.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/plane_density.hpp"
#include "windlass/rod/surface_density.hpp"

/// Densities of rods that stretch, r' = (1 + ε) d₃ with ε = k n·d₃, k = 1/EA the compliance [ρ²/EI]; strains, moments and
/// forces per length count reference lengths (PHYSICS, "Rods that stretch"). With k = 0 they are the inextensible ones.
namespace windlass::rod {

/// Stretch makes no curvature where the surface has none: free rods, and rods on a plane. With d the tangent and N = n·d,
///
///     L = W − N − ½ k N²,   ∂L/∂n = −(1 + k N) d,
///
/// which is L of the inextensible rod under the force λ n, λ = 1 + k N frozen, plus ½ k N²; its Hessian has −k ∇N ∇Nᵀ more.
template <class Inextensible>
struct Extensible {
  using Configuration = typename Inextensible::Configuration;
  static constexpr int ambient = Inextensible::ambient, forces = Inextensible::forces;
  static constexpr bool stretches = true;
  using Q = Eigen::Matrix<double, ambient, 1>;
  using Z = Eigen::Matrix<double, 2 * ambient, 1>;
  using Force = Eigen::Matrix<double, forces, 1>;

  Inextensible rod;

  double elastic(const Q& q, const Q& slope, const Force& n, double k) const {
    const double along = n.dot(rod.direction(q));
    return rod.elastic(q, slope) + 0.5 * k * along * along;
  }
  double first(const Q& q, const Q& slope, const Force& n, double k, Z& gz, Force& d) const {
    const double along = n.dot(rod.direction(q)), stretch = 1.0 + k * along;
    const double value = rod.first(q, slope, Force(stretch * n), gz, d);
    d *= stretch;
    return value + 0.5 * k * along * along;
  }
  /// @param d_q, d_slope  ∂d/∂q, ∂d/∂q'
  /// @param d_n  ∂d/∂n
  void second(const Q& q, const Q& slope, const Force& n, double k, Z& gz,
              Eigen::Matrix<double, 2 * ambient, 2 * ambient>& hz, Force& d,
              Eigen::Matrix<double, forces, ambient>& d_q, Eigen::Matrix<double, forces, ambient>& d_slope,
              Eigen::Matrix<double, forces, forces>& d_n) const {
    const double stretch = 1.0 + k * n.dot(rod.direction(q));
    Eigen::Matrix<double, forces, ambient> dd;
    rod.second(q, slope, Force(stretch * n), gz, hz, d, dd);
    const Q along_q = dd.transpose() * n;
    hz.template topLeftCorner<ambient, ambient>() -= k * along_q * along_q.transpose();
    d_q = stretch * dd + k * d * along_q.transpose();
    d_slope.setZero();
    d_n = k * d * d.transpose();
    d *= stretch;
  }
};

/// On the unit cylinder a stretch λ = 1 + ε bends and twists: a' = λ cos ψ, z' = λ sin ψ, κ_n = λ cos²ψ,
/// u₃ = χ' + λ sin ψ cos ψ. With N = n·(cos ψ, sin ψ) − C χ' sin ψ cos ψ and Q = B cos⁴ψ + C sin²ψ cos²ψ,
///
///     L = ½ B ψ'² + ½ C χ'² + stat_λ [½ Q λ² − N λ + (λ − 1)²/2k]
///       = ½ B ψ'² + ½ C χ'² + ½ (Q − 2N − k N²)/(1 + k Q),   λ = (1 + k N)/(1 + k Q),
///
/// ∂L/∂N = −λ, ∂L/∂Q = ½ λ², and λ − 1 = k n₃ with the tension n₃ = (N − Q)/(1 + k Q).
template <>
struct Extensible<SurfaceDensity> {
  using Configuration = bvp::Coordinates<2>;
  static constexpr int ambient = 2, forces = 2;
  static constexpr bool stretches = true;
  using Vector2 = Eigen::Vector2d;
  using Vector4 = Eigen::Vector4d;

  SurfaceDensity rod;

  /// What λ is made of, at one section.
  struct Parts {
    double c, s, cos2, force, bend, divisor, stretch;  ///< force: N, bend: Q, divisor: 1 + k Q
  };
  Parts parts(const Vector2& q, const Vector2& slope, const Vector2& n, double k) const {
    Parts at{};
    at.c = std::cos(q(0)), at.s = std::sin(q(0)), at.cos2 = at.c * at.c - at.s * at.s;
    const double sc = at.s * at.c;
    at.force = n(0) * at.c + n(1) * at.s - rod.twisting_stiffness * slope(1) * sc;
    at.bend = rod.bending_stiffness * at.c * at.c * at.c * at.c + rod.twisting_stiffness * sc * sc;
    at.divisor = 1.0 + k * at.bend;
    at.stretch = (1.0 + k * at.force) / at.divisor;
    return at;
  }
  double elastic(const Vector2& q, const Vector2& slope, const Vector2& n, double k) const {
    const Parts at = parts(q, slope, n, k);
    const double tension = (at.force - at.bend) / at.divisor, twist = slope(1) + at.stretch * at.s * at.c,
                 normal = at.stretch * at.c * at.c;
    return 0.5 * rod.bending_stiffness * (slope(0) * slope(0) + normal * normal) +
           0.5 * rod.twisting_stiffness * twist * twist + 0.5 * k * tension * tension;
  }
  double first(const Vector2& q, const Vector2& slope, const Vector2& n, double k, Vector4& gz,
               Vector2& d) const {
    const Parts at = parts(q, slope, n, k);
    const Slopes by_psi = slopes(at, slope, n);
    gz << -at.stretch * by_psi.force + 0.5 * at.stretch * at.stretch * by_psi.bend, 0.0,
        rod.bending_stiffness * slope(0), rod.twisting_stiffness * (slope(1) + at.stretch * at.s * at.c);
    d = at.stretch * Vector2(at.c, at.s);
    return 0.5 * rod.bending_stiffness * slope(0) * slope(0) +
           0.5 * rod.twisting_stiffness * slope(1) * slope(1) +
           0.5 * (at.bend - 2.0 * at.force - k * at.force * at.force) / at.divisor;
  }
  void second(const Vector2& q, const Vector2& slope, const Vector2& n, double k, Vector4& gz,
              Eigen::Matrix4d& hz, Vector2& d, Eigen::Matrix2d& d_q, Eigen::Matrix2d& d_slope,
              Eigen::Matrix2d& d_n) const {
    first(q, slope, n, k, gz, d);
    const Parts at = parts(q, slope, n, k);
    const Slopes by_psi = slopes(at, slope, n);
    const double b = rod.bending_stiffness, t = rod.twisting_stiffness, c = at.c, s = at.s, sc = s * c;
    const double force_2 = -n(0) * c - n(1) * s + 4.0 * t * slope(1) * sc,
                 bend_2 =
                     -4.0 * b * c * c * (c * c - 3.0 * s * s) + 2.0 * t * (at.cos2 * at.cos2 - 4.0 * sc * sc);
    // λ changes by k/(1 + k Q) (δN − λ δQ), and so does L twice by −k/(1 + k Q) (δN − λ δQ)².
    const double soft = k / at.divisor, by_angle = by_psi.force - at.stretch * by_psi.bend,
                 by_twist = -t * sc;
    hz.setZero();
    hz(0, 0) = -at.stretch * force_2 + 0.5 * at.stretch * at.stretch * bend_2 - soft * by_angle * by_angle;
    hz(0, 3) = hz(3, 0) = at.stretch * t * at.cos2 - soft * by_angle * by_twist;
    hz(2, 2) = b;
    hz(3, 3) = t - soft * by_twist * by_twist;
    const Vector2 along(c, s);
    d_q << at.stretch * Vector2(-s, c) + soft * by_angle * along, Vector2::Zero();
    d_slope << Vector2::Zero(), soft * by_twist * along;
    d_n = soft * along * along.transpose();
  }

 private:
  struct Slopes {
    double force, bend;  ///< of N and Q, with ψ
  };
  Slopes slopes(const Parts& at, const Vector2& slope, const Vector2& n) const {
    const double b = rod.bending_stiffness, t = rod.twisting_stiffness;
    return {-n(0) * at.s + n(1) * at.c - t * slope(1) * at.cos2,
            -4.0 * b * at.c * at.c * at.c * at.s + 2.0 * t * at.s * at.c * at.cos2};
  }
};

}  // namespace windlass::rod

extern template class windlass::bvp::LagrangianOf<windlass::rod::Extensible<windlass::rod::PlanarDensity>>;
extern template class windlass::bvp::LagrangianOf<windlass::rod::Extensible<windlass::rod::KirchhoffDensity>>;
extern template class windlass::bvp::LagrangianOf<windlass::rod::Extensible<windlass::rod::SurfaceDensity>>;
extern template class windlass::bvp::LagrangianOf<windlass::rod::Extensible<windlass::rod::PlaneDensity>>;
