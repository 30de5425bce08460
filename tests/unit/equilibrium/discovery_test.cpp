#include "windlass/equilibrium/discovery.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/start.hpp"

using namespace windlass;
using equilibrium::Discovery;
using equilibrium::DiscoveryOptions;
using equilibrium::NodalContact;

BOOST_AUTO_TEST_SUITE(discovery)

namespace {

constexpr double pi = std::numbers::pi;

Discovery discover(double angle, double tension, int elements = 80, bool clamped = false,
                   double half_length = 15.0) {
  contact::Loads loads;
  loads.angle = angle;
  loads.tension = tension;
  loads.half_length = half_length;
  DiscoveryOptions options;
  options.elements = elements;
  options.clamped = clamped;
  return equilibrium::discover_contacts(loads, options);
}

/// (2T − 1) φ* + √(4T − 1) of an infinite rod in line contact.
double line_contact_total(double angle, double tension) {
  const double phi_star = 0.5 * angle - std::acos(1.0 - 0.5 / tension);
  return (2.0 * tension - 1.0) * phi_star + std::sqrt(4.0 * tension - 1.0);
}

/// Gap and force are non-negative and never both positive; the pulls balance the contact forces.
void check_physics(const Discovery& d, double angle, double tension) {
  BOOST_TEST_REQUIRE(d.converged);
  double vertical = 0.0;
  for (std::size_t k = 0; k < d.s.size(); ++k) {
    BOOST_TEST(d.gap[k] > -1e-6);
    BOOST_TEST(d.force[k] >= 0.0);
    BOOST_TEST(std::min(d.gap[k], d.force[k]) < 1e-6);
    vertical += 2.0 * d.force[k] * d.y[k] / (1.0 + d.gap[k]);
  }
  BOOST_TEST(std::abs(vertical + 2.0 * tension * std::sin(0.5 * angle)) < 1e-6);
  double total = 0.0;
  for (const NodalContact& contact : d.contacts) total += 2.0 * contact.force;
  BOOST_TEST(std::abs(total - d.R_tot) < 1e-6);
}

}  // namespace

BOOST_AUTO_TEST_CASE(line_contact_meets_the_closed_form) {
  for (const double turns : {1.0, 2.0}) {
    const double angle = 2.0 * pi * turns, exact = line_contact_total(angle, 1.0);
    const Discovery d = discover(angle, 1.0);
    check_physics(d, angle, 1.0);
    BOOST_TEST(std::abs(d.R_tot / exact - 1.0) < 2e-3);
    BOOST_TEST_REQUIRE(d.contacts.size() == 1u);
    const NodalContact& line = d.contacts.front();
    BOOST_TEST((line.kind == NodalContact::Kind::line));
    BOOST_TEST(line.s_begin == 0.0);
    BOOST_TEST(std::abs(line.s_end - (0.5 * angle - std::acos(0.5))) < 0.1);
    BOOST_TEST(std::abs(line.angle_end - line.s_end) < 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(the_error_falls_with_the_mesh) {
  const double exact = line_contact_total(2.0 * pi, 1.0);
  double last = 1.0;
  for (const int elements : {20, 40, 80, 160}) {
    const double error = std::abs(discover(2.0 * pi, 1.0, elements).R_tot / exact - 1.0);
    BOOST_TEST_MESSAGE(elements << " elements: relative error of R_tot " << error);
    BOOST_TEST(error < 0.5 * last);
    last = error;
  }
  BOOST_TEST(last < 2e-4);
}

BOOST_AUTO_TEST_CASE(a_weak_pull_at_a_small_angle_touches_once) {
  for (const bool clamped : {false, true}) {
    const Discovery d = discover(0.5 * pi, 0.3, 80, clamped);
    check_physics(d, 0.5 * pi, 0.3);
    BOOST_TEST(std::abs(d.R_tot - 0.6 * std::sin(0.25 * pi)) < 1e-6);
    BOOST_TEST_REQUIRE(d.contacts.size() == 1u);
    BOOST_TEST((d.contacts.front().kind == NodalContact::Kind::touch));
    BOOST_TEST(d.contacts.front().s_begin == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(below_the_line_limit_a_coil_touches_at_its_sides) {
  // The pulls of the 2 pi coil are horizontal and cancel: only forces along x, at ±pi/2, balance.
  const Discovery d = discover(2.0 * pi, 0.4);
  check_physics(d, 2.0 * pi, 0.4);
  BOOST_TEST_REQUIRE(d.contacts.size() == 1u);
  const NodalContact& touch = d.contacts.front();
  BOOST_TEST((touch.kind == NodalContact::Kind::touch));
  BOOST_TEST(std::abs(touch.angle_begin - 0.5 * pi) < 1e-3);
  BOOST_TEST(d.gap.front() > 1e-3);
}

BOOST_AUTO_TEST_CASE(two_turns_below_the_line_limit) {
  const Discovery d = discover(4.0 * pi, 0.45);
  check_physics(d, 4.0 * pi, 0.45);
  for (const NodalContact& contact : d.contacts)
    BOOST_TEST_MESSAGE((contact.kind == NodalContact::Kind::line ? "line " : "touch ")
                       << contact.angle_begin / pi << " pi, force " << contact.force);
  BOOST_TEST(!d.contacts.empty());
}

// Under so weak a pull this coil has no flat state in contact. On the way down all nodes let go at once,
// nothing holds the rod any more, and the matrix of that step is singular: an answer, not an error.
BOOST_AUTO_TEST_CASE(a_coil_that_lifts_off_is_not_found) {
  const double angle = 9.85468;
  const Discovery d = discover(angle, 0.05, 80, false, 0.5 * angle + 11.0);
  BOOST_TEST(d.contacts.empty());
}

// The arcs' state on the discovered contacts is that of the other ways in, which never saw them.
BOOST_AUTO_TEST_CASE(arcs_start_from_discovered_contacts) {
  struct Case {
    double tension, angle;
  };
  for (const Case& c : {Case{1.0, 2.0 * pi}, Case{0.4, 2.0 * pi}, Case{0.3, 0.5 * pi}})
    for (const bool spatial : {false, true}) {
      scene::Scene scene = test::coil_scene(c.tension);
      scene.load.angle = c.angle;
      const std::vector<std::string> keys{"load.tension"};
      std::optional<equilibrium::Started> found = equilibrium::discovered_start(scene, spatial, true, keys);
      equilibrium::Started known = equilibrium::cold_start(scene, spatial, true, keys);
      BOOST_TEST_CONTEXT("T " << c.tension << ", phi " << c.angle << (spatial ? ", 3D" : ", plane")) {
        BOOST_TEST_REQUIRE(found.has_value());
        BOOST_TEST(found->problem->topology().text() == known.problem->topology().text());
        const auto force = [](equilibrium::Started& start) {
          return chain::total_contact_force(start.problem->profile(start.x, start.p),
                                            start.problem->topology());
        };
        BOOST_TEST(std::abs(force(*found) / force(known) - 1.0) < 2e-8);  // twice the scene's tolerance
      }
    }
}

BOOST_AUTO_TEST_CASE(wrong_arguments_name_the_bound) {
  BOOST_CHECK_THROW(discover(2.0 * pi, 0.0), std::invalid_argument);
  BOOST_CHECK_THROW(discover(-1.0, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(discover(40.0, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(discover(2.0 * pi, 1.0, 3), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
