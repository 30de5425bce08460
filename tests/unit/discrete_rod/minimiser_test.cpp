// The plain discrete elastic rod: derivatives of its energy, convergence of its minima, and what it refuses.
#include "windlass/discrete_rod/minimiser.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/petsc_session.hpp"
#include "windlass/discrete_rod/energy.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass;
namespace capstan = rod::capstan;

namespace {

contact::Loads coil(double tension, double angle, double half_length) {
  contact::Loads loads;
  loads.tension = tension;
  loads.angle = angle;
  loads.half_length = half_length;
  return loads;
}

discrete_rod::Minimum minimum(int edges, bool clamped = false) {
  discrete_rod::MinimiserOptions options;
  options.edges = edges;
  options.clamped = clamped;
  return discrete_rod::minimise(coil(2.0, 2.0 * M_PI, 10.0), options);
}

double force_error(int edges) {
  return std::abs(minimum(edges).R_tot / capstan::total_force(2.0, 2.0 * M_PI) - 1.0);
}

}  // namespace

BOOST_FIXTURE_TEST_SUITE(discrete_rods, test::PetscSession)

BOOST_AUTO_TEST_CASE(gradient_and_hessian_are_those_of_the_energy) {
  for (const bool clamped : {false, true}) {
    discrete_rod::Energy energy(coil(2.0, 3.0, 4.0), 12, clamped);
    energy.set_stiffness(50.0, 30.0);
    // Off the minimum, with some nodes inside the cylinder and some outside.
    Eigen::VectorXd x = energy.first_guess();
    for (Eigen::Index k = 0; k < x.size(); ++k) x(k) += 0.05 * std::sin(7.0 * static_cast<double>(k) + 1.0);
    const Eigen::VectorXd gradient = energy.gradient(x);
    const Eigen::MatrixXd hessian = energy.hessian(x);
    constexpr double step = 1e-6;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd up = x, down = x;
      up(k) += step, down(k) -= step;
      // Central differences: step² times third derivatives of some hundreds, and rounding/step.
      BOOST_TEST(std::abs((energy.value(up) - energy.value(down)) / (2.0 * step) - gradient(k)) < 1e-7);
      const Eigen::VectorXd column = (energy.gradient(up) - energy.gradient(down)) / (2.0 * step);
      BOOST_TEST((column - hessian.col(k)).lpNorm<Eigen::Infinity>() < 1e-6);
    }
    BOOST_TEST((hessian - hessian.transpose()).lpNorm<Eigen::Infinity>() < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(the_contact_force_converges_with_second_order) {
  // Tails of 7 and more at T = 2: the closed form of infinite ones is exact to exp(−2√2·7.6) = 5e-10. Where the edge of the
  // contact falls between nodes decides on a factor of some three at each mesh, so the order is taken over 1 to 16.
  const double coarse = force_error(40), fine = force_error(640);
  const double order = std::log2(coarse / fine) / 4.0;
  BOOST_TEST_MESSAGE("errors " << coarse << ", " << fine << ": order " << order);
  BOOST_TEST(order > 1.5);
  BOOST_TEST(order < 2.6);
  BOOST_TEST(fine < 1e-4);
}

BOOST_AUTO_TEST_CASE(contact_energy_and_angle_are_those_of_the_closed_form) {
  const discrete_rod::Minimum found = minimum(400);
  BOOST_REQUIRE(found.converged);
  BOOST_TEST(found.unknowns == 801);
  const double beta = capstan::beta(2.0), arc = capstan::phi_star(2.0, 2.0 * M_PI);
  // Two homoclinic tails of bending energy 2 √T (1 − cos(β/2)) each, and the arc's ½ a unit length.
  const double energy = arc + 4.0 * std::sqrt(2.0) * (1.0 - std::cos(0.5 * beta));
  BOOST_TEST(std::abs(found.energy / energy - 1.0) < 1e-3);  // h = 1/40: h² = 6e-4
  BOOST_TEST(std::abs(found.phi_star - arc) < 2.0 / 40.0);   // places of nodes, two edges
}

BOOST_AUTO_TEST_CASE(clamped_ends_far_away_change_nothing) {
  const double free = minimum(200).R_tot, clamped = minimum(200, true).R_tot;
  BOOST_TEST(free != clamped);
  BOOST_TEST(std::abs(free / clamped - 1.0) < 1e-6);  // exp(−√2·7.6) at the end, squared at the contact
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  discrete_rod::MinimiserOptions options;
  BOOST_CHECK_THROW(discrete_rod::minimise(coil(0.5, 6.0, 10.0)), std::invalid_argument);
  BOOST_CHECK_THROW(discrete_rod::minimise(coil(2.0, 6.0, 2.0)), std::invalid_argument);
  options.edges = 3;
  BOOST_CHECK_THROW(discrete_rod::minimise(coil(2.0, 6.0, 10.0), options), std::invalid_argument);
  options = {};
  options.penalty = -1.0;
  BOOST_CHECK_THROW(discrete_rod::minimise(coil(2.0, 6.0, 10.0), options), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
