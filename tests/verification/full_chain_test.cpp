// The full chain against the half chain, wherever the contact is: a line, two touches, one touch at the mid-point.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/diagram.hpp>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/analysis.hpp"

namespace {

using namespace windlass;
using equilibrium::Started;

scene::Scene coil(double tension, double angle, scene::EndKind ends = scene::EndKind::moment_free) {
  scene::Scene scene = test::coil_scene(tension, ends);
  scene.load.angle = angle;
  return scene;
}

double contact_force(Started& start) {
  return chain::total_contact_force(start.problem->profile(start.x, start.p), start.problem->topology());
}

stability::SpectrumSolver& solver() {
  static stability::SpectrumSolver one;
  return one;
}

equilibrium::Stability stability_of(Started& start) {
  start.problem->error_estimate(start.x, start.p);
  return stability::analyse(*start.problem, start.x, start.p, 4, false, solver());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(full_chain)

BOOST_AUTO_TEST_CASE(force_and_index_are_those_of_the_half_chain) {
  struct Case {
    double tension, angle;
    scene::EndKind ends = scene::EndKind::moment_free;
  };
  for (const Case& c :
       {Case{1.5, 2.0 * M_PI}, Case{1.0, 2.0 * M_PI}, Case{0.4, 2.0 * M_PI}, Case{0.3, M_PI},
        Case{0.4999, M_PI}, Case{0.1, 0.5 * M_PI}, Case{0.1, 0.5 * M_PI, scene::EndKind::clamped},
        Case{0.4, 2.0, scene::EndKind::clamped}})
    for (const bool spatial : {false, true}) {
      const std::vector<std::string> keys{"load.tension"};
      Started half = equilibrium::cold_start(coil(c.tension, c.angle, c.ends), spatial, true, keys);
      Started full = equilibrium::cold_start(coil(c.tension, c.angle, c.ends), spatial, false, keys);
      const equilibrium::Stability a = stability_of(half), b = stability_of(full);
      BOOST_TEST_CONTEXT("T " << c.tension << ", phi " << c.angle << ", " << (spatial ? "3D" : "plane")
                              << ", " << full.problem->topology().text()) {
        BOOST_TEST(full.problem->topology().text() == half.problem->topology().text());
        // Twice the tolerance of the scene, 1e-8.
        BOOST_TEST(std::abs(contact_force(full) / contact_force(half) - 1.0) < 2e-8);
        BOOST_TEST(a.index == b.index);
        BOOST_TEST(b.index == b.inertia_index);
        // Both parities' lowest eigenvalues against the full chain's, on meshes that differ: 1e-7 of the largest of them.
        for (std::size_t k = 0; k < 2; ++k)
          BOOST_TEST(std::abs(a.eigenvalues.at(k) - b.eigenvalues.at(k)) < 1e-7);
      }
    }
}

// Pulls that are parallel (pi) or along one line (2 pi) leave a flat rod on isolated touches free to turn: one eigenvalue
// is zero, which is neither unstable nor an obstacle.
BOOST_AUTO_TEST_CASE(a_turn_that_costs_nothing_is_neutral) {
  for (const double angle : {M_PI, 2.0 * M_PI})
    for (const bool half : {true, false}) {
      Started start = equilibrium::cold_start(coil(0.4, angle), true, half, {"load.tension"});
      const equilibrium::Stability found = stability_of(start);
      BOOST_TEST_CONTEXT("phi " << angle << ", half " << half) {
        const auto neutral = std::count_if(found.eigenvalues.begin(), found.eigenvalues.end(),
                                           [](double value) { return std::abs(value) < 1e-11; });
        BOOST_TEST(neutral == 1);
        // The loop of a full turn would rather become a helix; the bight is stable.
        BOOST_TEST(found.index == (angle > 4.0 ? 1 : 0));
        BOOST_TEST(found.inertia_index == found.index);
      }
    }
}

BOOST_AUTO_TEST_CASE(the_flat_coil_passes_through_its_contact_events) {
  struct Case {
    double angle, lower;
    std::vector<std::string> after;  // what follows each event
  };
  for (const Case& c : {Case{0.5 * M_PI, 0.5, {"tail touch tail"}}, Case{M_PI, 0.2, {"tail touch tail"}},
                        Case{2.0 * M_PI, 0.2, {"tail touch gap touch tail", "no contact"}}})
    for (const bool spatial : {false, true}) {
      Started start = equilibrium::cold_start(coil(2.0, c.angle), spatial, false, {"load.tension"});
      continuation::Options options;
      options.target = c.lower;
      options.direction = -1;
      options.newton_tolerance = 1e-9;
      continuation::Walker walker(start.problem, start.x, start.p, options);
      std::vector<std::string> after;
      while (const auto point = walker.step())
        if (point->type == continuation::PointType::event) after.push_back(point->after);
      BOOST_TEST_CONTEXT("phi " << c.angle << (spatial ? ", 3D" : ", plane")) {
        BOOST_TEST(after == c.after, boost::test_tools::per_element());
        BOOST_TEST(!walker.end().lost(), walker.end().reason);
      }
    }
}

BOOST_AUTO_TEST_SUITE_END()
