#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>

/// What the oracles of dragged rods share.
namespace windlass::test {

/// A section on the unit cylinder; d₂ = t × d₁.
struct OnCylinder {
  Eigen::Vector3d r, t, d1;
};

/// @param x  angle, height, inclination of the tangent, turn about it from the normal
inline OnCylinder on_cylinder(const Eigen::Vector4d& x) {
  const Eigen::Vector3d out(std::sin(x(0)), -std::cos(x(0)), 0.0), round(std::cos(x(0)), std::sin(x(0)), 0.0);
  OnCylinder at;
  at.r = out + x(1) * Eigen::Vector3d::UnitZ();
  at.t = std::cos(x(2)) * round + std::sin(x(2)) * Eigen::Vector3d::UnitZ();
  at.d1 = std::cos(x(3)) * out + std::sin(x(3)) * out.cross(at.t);
  return at;
}

/// The same of a place and a unit quaternion (1, i, j, k).
inline Eigen::Vector4d coordinates_on_cylinder(const Eigen::Vector3d& r, const Eigen::Vector4d& q) {
  using Eigen::Vector3d;
  const Eigen::Matrix3d d = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
  const Vector3d out = Vector3d(r.x(), r.y(), 0.0).normalized(), t = d.col(2);
  return {std::atan2(r.x(), -r.y()), r.z(), std::atan2(t.z(), Vector3d::UnitZ().cross(out).dot(t)),
          std::atan2(d.col(0).dot(out.cross(t)), d.col(0).dot(out))};
}

/// Newton's method with differences from a guess, moved by `off` so that it has to find the state itself. @returns the unknowns after a
/// correction below `tolerance`
template <typename Residual>
Eigen::VectorXd newton_shot(const Residual& residual, Eigen::VectorXd x, double off, double tolerance) {
  x += off * Eigen::VectorXd::LinSpaced(x.size(), -1.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    const Eigen::VectorXd f = residual(x);
    Eigen::MatrixXd j(f.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double step = 1e-6;
      Eigen::VectorXd up = x, down = x;
      up(i) += step, down(i) -= step;
      j.col(i) = (residual(up) - residual(down)) / (2.0 * step);
    }
    const Eigen::VectorXd dx = -j.fullPivLu().solve(f);
    x += dx;
    if (dx.lpNorm<Eigen::Infinity>() <= tolerance) return x;
  }
  BOOST_FAIL("the oracle did not converge");
  return x;
}

}  // namespace windlass::test
