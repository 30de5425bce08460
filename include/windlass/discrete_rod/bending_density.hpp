#pragma once

#include <Eigen/Core>
#include <cmath>

namespace windlass::discrete_rod {

/// ½ |a×b|²/|a|⁵ with a = r', b = r'': half the curvature's square times |r'|.
struct BendingDensity {
  double value;
  Eigen::Matrix<double, 6, 1> gradient;
  Eigen::Matrix<double, 6, 6> hessian;

  // At every Gauss point of every step.
  [[gnu::always_inline]] BendingDensity(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const double p = a.squaredNorm(), q = b.squaredNorm(), s = a.dot(b), p3 = 1.0 / (p * std::sqrt(p)),
                 p5 = p3 / p, p7 = p5 / p, p9 = p7 / p;
    value = 0.5 * (q * p3 - s * s * p5);
    const double by_p = -0.75 * q * p5 + 1.25 * s * s * p7, by_q = 0.5 * p3, by_s = -s * p5;
    const double by_pp = 1.875 * q * p7 - 4.375 * s * s * p9, by_pq = -0.75 * p5, by_ps = 2.5 * s * p7,
                 by_ss = -p5;
    gradient << 2.0 * by_p * a + by_s * b, 2.0 * by_q * b + by_s * a;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), aa = a * a.transpose(), ab = a * b.transpose();
    hessian.topLeftCorner<3, 3>() =
        2.0 * by_p * one + 4.0 * by_pp * aa + 2.0 * by_ps * (ab + ab.transpose()) + by_ss * b * b.transpose();
    hessian.topRightCorner<3, 3>() =
        by_s * one + 4.0 * by_pq * ab + 2.0 * by_ps * aa + by_ss * ab.transpose();
    hessian.bottomLeftCorner<3, 3>() = hessian.topRightCorner<3, 3>().transpose();
    hessian.bottomRightCorner<3, 3>() = 2.0 * by_q * one + by_ss * aa;
  }
};

}  // namespace windlass::discrete_rod
