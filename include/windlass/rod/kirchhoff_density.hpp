#pragma once

#include "windlass/bvp/collocation_arc.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::rod {

/// Free arc of a Kirchhoff rod under end loads only:  L(q, q', n) = ½ Σ K_i (u_i − û_i)² − n·d₃(q).
///
/// Written for quaternions of any length, N = |q|², so that polynomials in R⁴ may run between unit nodes:
///
///     u_i = 2 q'·(q⊗e_i)/N  (strains in the body frame),   d₃ = q e₃ q̄/N.
///
/// With the moments m_i = K_i (u_i − û_i), L's gradient is that of f = g/N,
/// g = 2 q'·(q⊗m) − q·D(n)q, at frozen m; its Hessian adds Σ K_i ∇u_i ∇u_iᵀ.
struct KirchhoffDensity {
  using Configuration = UnitQuaternions;
  static constexpr int ambient = 4, forces = 3;
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  using Matrix8 = Eigen::Matrix<double, 8, 8>;

  Eigen::Vector3d stiffness = {1.0, 1.0, 2.0 / 3.0};  ///< K = (EI1, EI2, GJ) [EI]
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();  ///< û, natural strains in the body frame [1/ρ]

  Eigen::Vector3d strain(const Quaternion& q, const Quaternion& slope) const {
    return 2.0 / q.squaredNorm() * (increments(q).transpose() * slope);
  }
  Eigen::Vector3d direction(const Quaternion& q) const {
    const double w = q(0), x = q(1), y = q(2), z = q(3);
    return Eigen::Vector3d(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z) /
           q.squaredNorm();
  }
  double elastic(const Quaternion& q, const Quaternion& slope) const {
    const Eigen::Vector3d e = strain(q, slope) - natural;
    return 0.5 * e.dot(stiffness.cwiseProduct(e));
  }
  double first(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n, Vector8& gz,
               Eigen::Vector3d& d) const;
  void second(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n, Vector8& gz,
              Matrix8& hz, Eigen::Vector3d& d, Eigen::Matrix<double, 3, 4>& dd) const;
};

/// D(n) with q·D(n)q = |q|² n·d₃(q).
inline Eigen::Matrix4d direction_form(const Eigen::Vector3d& n) {
  Eigen::Matrix4d d;
  d << n(2), -n(1), n(0), 0.0,  //
      -n(1), -n(2), 0.0, n(0),  //
      n(0), 0.0, -n(2), n(1),   //
      0.0, n(0), n(1), n(2);
  return d;
}

}  // namespace windlass::rod

extern template class windlass::bvp::LagrangianOf<windlass::rod::KirchhoffDensity>;
extern template class windlass::bvp::CollocationArc<windlass::rod::UnitQuaternions, 3>;
