// Quaternions against Eigen's, and increments against differences.
#include "windlass/rod/quaternion.hpp"

#include <boost/test/unit_test.hpp>

namespace {

using namespace windlass::rod;
using Eigen::Vector3d;

Quaternion some(unsigned seed) {
  std::srand(seed);
  return Quaternion::Random().normalized();
}

Eigen::Quaterniond eigen(const Quaternion& q) { return {q(0), q(1), q(2), q(3)}; }

}  // namespace

BOOST_AUTO_TEST_SUITE(quaternion)

BOOST_AUTO_TEST_CASE(products_and_rotations_are_eigens) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Quaternion a = some(seed), b = some(seed + 10);
    const Eigen::Quaterniond ab = eigen(a) * eigen(b);
    BOOST_TEST((product(a, b) - Quaternion(ab.w(), ab.x(), ab.y(), ab.z())).norm() < 1e-15);
    BOOST_TEST((product(a, conjugate(a)) - Quaternion::UnitX()).norm() < 1e-15);
    BOOST_TEST((directors(product(a, b)) - directors(a) * directors(b)).norm() < 1e-14);
    const Vector3d axis = Vector3d::Random().normalized();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, axis).toRotationMatrix();
    BOOST_TEST((directors(rotation(axis, 0.7)) - turn).norm() < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(an_increment_is_half_a_rotation_vector_in_the_body) {
  const Quaternion q = some(3);
  const Vector3d v(0.02, -0.03, 0.01);
  BOOST_TEST(std::abs(retract(q, v).norm() - 1.0) < 1e-15);
  // v = tan(angle/2) axis, exactly.
  const Quaternion exact = product(q, rotation(v.normalized(), 2.0 * std::atan(v.norm())));
  BOOST_TEST((retract(q, v) - exact).norm() < 1e-15);
  constexpr double h = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Quaternion difference =
        (retract(q, h * Vector3d::Unit(k)) - retract(q, -h * Vector3d::Unit(k))) / (2.0 * h);
    BOOST_TEST((increments(q).col(k) - difference).norm() < 1e-9);
  }
}

BOOST_AUTO_TEST_SUITE_END()
