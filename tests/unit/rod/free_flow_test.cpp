// A free rod as an initial-value problem: what it keeps, and the way back.
#include "windlass/rod/free_flow.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

namespace {

using namespace windlass::rod;

const Eigen::Vector3d force(0.7, -0.4, 0.2);

Section start() {
  const Quaternion q =
      product(rotation(Eigen::Vector3d::UnitZ(), 0.8), rotation(Eigen::Vector3d::UnitX(), -0.5));
  return {{1.0, 0.2, -0.3}, {0.5, -0.9, 0.4}, q};
}

Material flat_cable() {
  Material rod;
  rod.stiffness = {2.0, 1.0, 0.7};
  rod.natural = {0.1, -0.3, 0.2};
  return rod;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(free_flow_of_a_rod)

BOOST_AUTO_TEST_CASE(hamiltonian_and_moment_about_the_origin_are_kept) {
  const Material rod = flat_cable();
  const auto hamiltonian = [&](const Section& at) {
    const Eigen::Matrix3d d = directors(at.q);
    const Eigen::Vector3d m = d.transpose() * at.m, bend = m.cwiseQuotient(rod.stiffness);
    return 0.5 * m.dot(bend) + m.dot(rod.natural) + force.dot(d.col(2));  // m·u − W + n·d₃
  };
  const Section from = start(), to = free_flow(from, force, rod, 3.0);
  BOOST_TEST(std::abs(hamiltonian(to) - hamiltonian(from)) < 1e-11);
  const auto torque = [&](const Section& at) { return Eigen::Vector3d(at.m + at.r.cross(force)); };
  BOOST_TEST((torque(to) - torque(from)).norm() < 1e-11);
  BOOST_TEST((to.r - from.r).norm() < 3.0);
}

BOOST_AUTO_TEST_CASE(the_way_back_leads_to_the_start) {
  const Section from = start(),
                back = free_flow(free_flow(from, force, flat_cable(), 2.0), force, flat_cable(), -2.0);
  BOOST_TEST((back.r - from.r).norm() < 1e-11);
  BOOST_TEST((back.m - from.m).norm() < 1e-11);
  BOOST_TEST(std::abs(std::abs(back.q.dot(from.q)) - 1.0) < 1e-12);
}

BOOST_AUTO_TEST_CASE(without_force_an_even_rod_is_a_helix_of_its_moment) {
  Section from = start();
  from.m = {0.0, 0.0, 0.8};  // bending about e_z alone: a circle if the tangent is normal to it
  from.q = rotation(Eigen::Vector3d::UnitY(), 0.5 * M_PI);
  const double radius = 1.0 / 0.8;
  const Section half = free_flow(from, Eigen::Vector3d::Zero(), Material{}, M_PI * radius);
  BOOST_TEST(std::abs((half.r - from.r).norm() - 2.0 * radius) < 1e-11);
}

BOOST_AUTO_TEST_SUITE_END()
