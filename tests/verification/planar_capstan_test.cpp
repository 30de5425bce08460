// The planar capstan against its closed form: R_tot, phi_star, p, f from a cold start.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"

namespace {

using namespace windlass;
using equilibrium::Started;

constexpr double angles[] = {M_PI / 4, M_PI / 2, M_PI, 2 * M_PI, 4 * M_PI};

scene::Scene capstan(double tension, double angle, double length) {
  scene::Scene scene;
  scene.name = "test";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = angle;
  scene.rod.length = length;
  scene.model.kind = scene::ModelKind::planar;
  scene.model.tolerance = 1e-10;
  return scene;
}

equilibrium::Solution solved(const scene::Scene& scene, bool spatial = false, bool half = true) {
  Started started = equilibrium::cold_start(scene, spatial, half, {"load.tension"});
  return equilibrium::record(*started.problem, started.x, started.p);
}

/// Tensions from the line-contact limit (0.51 at least) to 1e4, six a decade.
std::vector<double> tensions(double angle) {
  std::vector<double> all;
  const double lowest = std::max(0.51, 1.0001 * rod::capstan::line_limit(angle));
  for (double t = lowest; t < 1e4; t *= 1.4678) all.push_back(t);
  all.push_back(1e4);
  return all;
}

double relative(double value, double exact) { return std::abs(value / exact - 1.0); }

void check_against_closed_form(const equilibrium::Solution& s, double t, double angle, double bound) {
  BOOST_TEST_CONTEXT("T = " << t << ", phi = " << angle) {
    BOOST_TEST(relative(s.R_tot, rod::capstan::total_force(t, angle)) < bound);
    // phi_star vanishes at the limit for phi < pi: relative to the angle imposed there.
    BOOST_TEST(std::abs(s.phi_star - rod::capstan::phi_star(t, angle)) < bound * std::min(1.0, 0.5 * angle));
    BOOST_TEST(s.topology == "tail line tail");
    for (const auto& arc : s.arcs)
      if (arc.kind == equilibrium::ArcKind::line)
        BOOST_TEST(relative(arc.p.maxCoeff(), rod::capstan::pressure(t)) < bound);
    for (const auto& joint : s.joints)
      if (joint.kind == equilibrium::JointKind::edge)
        BOOST_TEST(relative(joint.force, rod::capstan::edge_force(t)) < bound);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(planar_capstan)

BOOST_AUTO_TEST_CASE(infinite_tails_equal_the_closed_form) {
  for (double angle : angles)
    for (double t : tensions(angle))
      check_against_closed_form(solved(capstan(t, angle, std::numeric_limits<double>::infinity())), t, angle,
                                1e-10);
}

BOOST_AUTO_TEST_CASE(long_finite_rods_equal_the_closed_form) {
  // exp(−2 √T L_tail) must be below the bound: L_tail = 16/√0.51 gives 1e-14.
  for (double angle : angles)
    for (double t : tensions(angle))
      check_against_closed_form(solved(capstan(t, angle, angle + 2.0 * 18.0 / std::sqrt(std::min(t, 1.0)))),
                                t, angle, 1e-9);
}

BOOST_AUTO_TEST_CASE(finite_length_tends_to_infinite_length_at_the_homoclinic_rate) {
  const double t = 1.0, angle = 2 * M_PI, exact = rod::capstan::total_force(t, angle);
  std::vector<double> logs, tails;
  for (double tail : {2.0, 3.0, 4.0, 5.0}) {
    const double length = 2.0 * (rod::capstan::phi_star(t, angle) + tail);
    logs.push_back(std::log(std::abs(solved(capstan(t, angle, length)).R_tot - exact)));
    tails.push_back(tail);
  }
  for (std::size_t k = 1; k < logs.size(); ++k) {
    const double rate = -(logs[k] - logs[k - 1]) / (tails[k] - tails[k - 1]);
    // The tail's own length changes with the edge, which alters the rate by a few per cent at L_tail = 2.
    BOOST_TEST(rate == 2.0 * std::sqrt(t), boost::test_tools::tolerance(0.06));
  }
}

BOOST_AUTO_TEST_CASE(one_touch_below_the_line_limit_is_force_balance) {
  for (double angle : {M_PI / 4, M_PI / 2}) {
    const double t = 0.6 * rod::capstan::line_limit(angle);
    const equilibrium::Solution s = solved(capstan(t, angle, 30.0));
    BOOST_TEST(s.topology == "tail touch tail");
    BOOST_TEST(relative(s.R_tot, 2.0 * t * std::sin(0.5 * angle)) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(below_one_half_a_full_turn_is_held_by_two_touches) {
  const equilibrium::Solution s = solved(capstan(0.4, 2 * M_PI, 30.0));
  BOOST_TEST(s.topology == "tail touch gap touch tail");
  // The pulls are along e_x: no net force along e_y, so the touches lie at ±π/2.
  BOOST_TEST(s.phi_star == 0.5 * M_PI, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(s.R_tot > 0.0);
  BOOST_TEST(s.invariants.hamiltonian_drift < 1e-9);
  BOOST_TEST(s.invariants.force_residual < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_loop_wider_than_the_cylinder_has_no_contact) {
  // The free homoclinic loop is (√2 − asinh 1)/√T wide to each side: wider than the unit cylinder below this tension.
  const double width = std::sqrt(2.0) - std::asinh(1.0);
  const double lift_off = width * width;
  BOOST_CHECK_THROW(solved(capstan(0.98 * lift_off, 2 * M_PI, 40.0)), equilibrium::NoEquilibrium);
  BOOST_TEST(solved(capstan(1.02 * lift_off, 2 * M_PI, 40.0)).topology == "tail touch gap touch tail");
}

BOOST_AUTO_TEST_CASE(half_and_full_chains_agree) {
  for (double t : {0.45, 1.0, 20.0}) {
    const scene::Scene scene = capstan(t, 2 * M_PI, 30.0);
    BOOST_TEST(relative(solved(scene, false, false).R_tot, solved(scene).R_tot) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(kirchhoff_rod_in_the_plane_equals_the_planar_rod) {
  for (double angle : angles)
    for (double t : {2.0, 20.0}) {
      const scene::Scene scene = capstan(t, angle, angle + 30.0);
      BOOST_TEST_CONTEXT("T = " << t << ", phi = " << angle)
      BOOST_TEST(relative(solved(scene, true).R_tot, solved(scene).R_tot) < 1e-10);
    }
}

BOOST_AUTO_TEST_CASE(clamped_ends_of_long_rods_change_nothing) {
  scene::Scene scene = capstan(1.0, 2 * M_PI, 60.0);
  scene.ends.kind = scene::EndKind::clamped;
  BOOST_TEST(relative(solved(scene).R_tot, rod::capstan::total_force(1.0, 2 * M_PI)) < 1e-9);
}

// Nothing is unknown there, neither a coordinate nor, to `solve`, a parameter.
BOOST_AUTO_TEST_CASE(one_touch_between_infinite_tails) {
  scene::Scene scene = capstan(2.0, 0.25 * M_PI, std::numeric_limits<double>::infinity());
  scene.model.kind = scene::ModelKind::planar;
  const equilibrium::Solution solution = equilibrium::solve(scene);
  BOOST_TEST(solution.R_tot == 4.0 * std::sin(0.125 * M_PI), boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_SUITE_END()
