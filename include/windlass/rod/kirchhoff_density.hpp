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
  static constexpr int ambient = 4, tangent = 3, forces = 3;
  static constexpr double metric_scale = 4.0;  ///< an increment v turns the frame by 2v
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
  Eigen::Matrix<double, 4, 3> basis(const Quaternion& q) const { return increments(q); }
  double radial(const Quaternion& q, const Quaternion& g) const { return -g.dot(q); }
  Quaternion normalised(const Quaternion& q) const { return q.normalized(); }
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

/// Right multiplication by the pure quaternion c: q ⊗ (0, c) = right_form(c)·q. Antisymmetric.
inline Eigen::Matrix4d right_form(const Eigen::Vector3d& c) {
  Eigen::Matrix4d b;
  b << 0.0, -c(0), -c(1), -c(2),  //
      c(0), 0.0, c(2), -c(1),     //
      c(1), -c(2), 0.0, c(0),     //
      c(2), c(1), -c(0), 0.0;
  return b;
}

inline double KirchhoffDensity::first(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n,
                                      Vector8& gz, Eigen::Vector3d& d) const {
  const double inverse = 1.0 / q.squaredNorm();
  const Eigen::Vector3d u = strain(q, slope), moment = stiffness.cwiseProduct(u - natural);
  const Quaternion bq = increments(q) * moment, bp = increments(slope) * moment, dq = direction_form(n) * q;
  const double g = 2.0 * slope.dot(bq) - q.dot(dq);
  d = direction(q);
  gz.head<4>() = inverse * (-2.0 * (bp + dq) - 2.0 * g * inverse * q);
  gz.tail<4>() = 2.0 * inverse * bq;
  return 0.5 * moment.dot(u - natural) - n.dot(d);
}

inline void KirchhoffDensity::second(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n,
                                     Vector8& gz, Matrix8& hz, Eigen::Vector3d& d,
                                     Eigen::Matrix<double, 3, 4>& dd) const {
  const double inverse = 1.0 / q.squaredNorm(), inverse2 = inverse * inverse;
  const Eigen::Matrix<double, 4, 3> tq = increments(q), tp = increments(slope);
  const Eigen::Vector3d u = 2.0 * inverse * (tq.transpose() * slope);
  const Eigen::Vector3d moment = stiffness.cwiseProduct(u - natural);
  const Eigen::Matrix4d form = direction_form(n);
  const Quaternion bq = tq * moment, bp = tp * moment, dq = form * q;
  const double g = 2.0 * slope.dot(bq) - q.dot(dq);
  const Quaternion gq = -2.0 * (bp + dq);
  d = direction(q);
  gz.head<4>() = inverse * gq - 2.0 * g * inverse2 * q;
  gz.tail<4>() = 2.0 * inverse * bq;

  Eigen::Matrix<double, 8, 3> du;  // ∇u_i
  du.topRows<4>() = -2.0 * inverse * (tp + q * u.transpose());
  du.bottomRows<4>() = 2.0 * inverse * tq;
  hz.noalias() = du * stiffness.asDiagonal() * du.transpose();
  hz.topLeftCorner<4, 4>() += -2.0 * inverse * form -
                              2.0 * inverse2 * (gq * q.transpose() + q * gq.transpose()) +
                              8.0 * g * inverse2 * inverse * q * q.transpose();
  hz.topLeftCorner<4, 4>().diagonal().array() -= 2.0 * g * inverse2;
  const Eigen::Matrix4d mixed = -2.0 * inverse * right_form(moment) - 4.0 * inverse2 * q * bq.transpose();
  // ∂²(2 q'·Bq)/∂q∂q' = 2Bᵀ = −2B, rows q, columns q'.
  hz.topRightCorner<4, 4>() += mixed;
  hz.bottomLeftCorner<4, 4>() += mixed.transpose();

  dd.row(0) = direction_form(Eigen::Vector3d::UnitX()) * q;
  dd.row(1) = direction_form(Eigen::Vector3d::UnitY()) * q;
  dd.row(2) = direction_form(Eigen::Vector3d::UnitZ()) * q;
  dd = 2.0 * inverse * (dd - d * q.transpose()).eval();
}

}  // namespace windlass::rod

extern template class windlass::bvp::CollocationArc<windlass::rod::KirchhoffDensity>;
