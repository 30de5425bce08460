#pragma once

#include <Eigen/Dense>

/// Unit quaternions as plain 4-vectors (w, x, y, z), body → world.
///
/// Increments are written on the right, q ⊗ (1, v)/|(1, v)|: v ∈ R³ is half the rotation vector, in the body frame,
/// to second order (v = tan(angle/2)·axis exactly).
namespace windlass::rod {

using Quaternion = Eigen::Vector4d;

/// Hamilton product a ⊗ b.
inline Quaternion product(const Quaternion& a, const Quaternion& b) {
  Quaternion c;
  c(0) = a(0) * b(0) - a.tail<3>().dot(b.tail<3>());
  c.tail<3>() = a(0) * b.tail<3>() + b(0) * a.tail<3>() + a.tail<3>().cross(b.tail<3>());
  return c;
}

inline Quaternion conjugate(const Quaternion& a) { return {a(0), -a(1), -a(2), -a(3)}; }

/// Rotation by `angle` [rad] about the unit vector `axis`.
inline Quaternion rotation(const Eigen::Vector3d& axis, double angle) {
  Quaternion q;
  q(0) = std::cos(0.5 * angle);
  q.tail<3>() = std::sin(0.5 * angle) * axis;
  return q;
}

/// The least rotation that takes the unit vector `from` to `to`, which are not opposite.
inline Quaternion turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Quaternion q;
  q(0) = 1.0 + from.dot(to);
  q.tail<3>() = from.cross(to);
  return q.normalized();
}

/// q ⊗ (1, v), normalised.
inline Quaternion retract(const Quaternion& q, const Eigen::Vector3d& v) {
  return product(q, Quaternion(1.0, v(0), v(1), v(2))) / std::sqrt(1.0 + v.squaredNorm());
}

/// Increments of q: columns q ⊗ (0, e_k). Shape 4×3.
inline Eigen::Matrix<double, 4, 3> increments(const Quaternion& q) {
  Eigen::Matrix<double, 4, 3> t;
  t << -q(1), -q(2), -q(3),  //
      q(0), -q(3), q(2),     //
      q(3), q(0), -q(1),     //
      -q(2), q(1), q(0);
  return t;
}

/// Unit quaternions as the configurations of an arc (bvp::CollocationArc).
struct UnitQuaternions {
  static constexpr int ambient = 4, tangent = 3;
  static constexpr double metric_scale = 4.0;  ///< an increment v turns the frame by 2v

  static Eigen::Matrix<double, 4, 3> basis(const Quaternion& q) { return increments(q); }
  static double radial(const Quaternion& q, const Quaternion& g) { return -g.dot(q); }
  static Quaternion normalised(const Quaternion& q) { return q.normalized(); }
};

/// Rotation matrix with the directors d1, d2, d3 as columns. q must be a unit quaternion.
inline Eigen::Matrix3d directors(const Quaternion& q) {
  return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
}

/// Increment of q as space turns by the rotation vector `turn` and the body about d3 by `spin` [rad], to first order.
inline Eigen::Vector3d turn_increment(const Quaternion& q, const Eigen::Vector3d& turn, double spin) {
  return 0.5 * (directors(q).transpose() * turn + spin * Eigen::Vector3d::UnitZ());
}

}  // namespace windlass::rod
