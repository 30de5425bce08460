// Closed forms against balance of forces, quadrature and differences.
#include "windlass/rod/closed_form_arcs.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/rod/capstan.hpp"
#include "windlass/rod/quaternion.hpp"

namespace {

using namespace windlass::rod;
using windlass::bvp::ArcPoint;
using windlass::bvp::EndsMatrix;
using windlass::bvp::EndsVector;

/// Frame whose tangent makes the angle θ with e_x in the plane.
Quaternion frame(double theta) {
  return product(rotation(Eigen::Vector3d::UnitZ(), theta), rotation(Eigen::Vector3d::UnitY(), 0.5 * M_PI));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(closed_forms)

BOOST_AUTO_TEST_CASE(contact_forces_balance_the_pulls) {
  for (const double phi : {0.5 * M_PI, M_PI, 2.0 * M_PI, 4.0 * M_PI})
    for (const double tension : {2.0, 5.0, 100.0}) {
      using namespace capstan;
      const double contact = phi_star(tension, phi);
      const double along_y =
          2.0 * pressure(tension) * std::sin(contact) + 2.0 * edge_force(tension) * std::cos(contact);
      BOOST_TEST(std::abs(along_y - 2.0 * tension * std::sin(0.5 * phi)) < 1e-12 * tension);
      BOOST_TEST(std::abs(total_force(tension, phi) -
                          2.0 * (pressure(tension) * contact + edge_force(tension))) < 1e-12 * tension);
      const double h = 1e-5;  // of log T
      const double slope =
          std::log(total_force(tension * std::exp(h), phi) / total_force(tension * std::exp(-h), phi)) /
          (2.0 * h);
      BOOST_TEST(log_slope(tension, phi) == slope, boost::test_tools::tolerance(1e-8));
    }
}

BOOST_AUTO_TEST_CASE(the_tail_is_the_pendulums_separatrix) {
  const double tension = 1.7, h = 1e-4;
  BOOST_TEST(capstan::tail_angle(tension, 0.0) == capstan::beta(tension),
             boost::test_tools::tolerance(1e-14));
  for (const double d : {0.3, 1.0, 2.5}) {
    const double psi = capstan::tail_angle(tension, d);
    const double bend =
        (capstan::tail_angle(tension, d + h) - 2.0 * psi + capstan::tail_angle(tension, d - h)) / (h * h);
    BOOST_TEST(bend == tension * std::sin(psi), boost::test_tools::tolerance(1e-6));  // h² and 1e-16/h²
  }
}

BOOST_AUTO_TEST_CASE(an_infinite_tails_action_moment_and_curvature) {
  const double stiffness = 1.3, theta = 0.9;
  const Eigen::Vector2d n(0.8, -0.4);
  const double psi = std::atan2(n(1), n(0)) - theta, tension = n.norm();
  TailArc planar(2, stiffness), spatial(3, stiffness);
  const double q[1] = {theta};
  const ArcPoint at{q, q, nullptr, n.data(), 1.0};
  // Energy by quadrature of ½ B θ'² along the separatrix, θ' = 2 √(T/B) sin(ψ/2).
  double energy = 0.0;
  const double rate = std::sqrt(tension / stiffness), step = 1e-3;
  for (double d = 0.5 * step; d < 40.0 / rate; d += step) {
    const double angle = 4.0 * std::atan(std::tan(0.25 * psi) * std::exp(-rate * d));
    energy += step * 2.0 * stiffness * rate * rate * std::pow(std::sin(0.5 * angle), 2);
  }
  BOOST_TEST(planar.energy(at) == energy, boost::test_tools::tolerance(1e-6));  // the midpoint rule's step²
  EndsVector g;
  planar.gradient(at, nullptr, g);
  BOOST_TEST(std::abs(g(0)) == 2.0 * std::sqrt(stiffness * tension) * std::abs(std::sin(0.5 * psi)),
             boost::test_tools::tolerance(1e-13));
  EndsMatrix h;
  planar.factor(at, h);
  constexpr double small = 1e-6;
  const double up[1] = {theta + small}, down[1] = {theta - small};
  EndsVector g_up, g_down;
  planar.gradient({up, up, nullptr, n.data(), 1.0}, nullptr, g_up);
  planar.gradient({down, down, nullptr, n.data(), 1.0}, nullptr, g_down);
  BOOST_TEST((EndsVector((g_up - g_down) / (2.0 * small)) - EndsVector(h.col(0))).norm() < 1e-8);

  // In space: the moment is about e_z, and its gradient ∓2 m in the body frame.
  const Quaternion frame_a = frame(theta);
  const Eigen::Vector3d n3(n(0), n(1), 0.0);
  EndsVector g3;
  spatial.gradient({frame_a.data(), frame_a.data(), nullptr, n3.data(), 1.0}, nullptr, g3);
  const Eigen::Vector3d moment = directors(frame_a) * (-0.5 * Eigen::Vector3d(g3.head<3>()));
  BOOST_TEST((moment - Eigen::Vector3d(0.0, 0.0, -g(0))).norm() < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
