#include "windlass/robustness/cold_start.hpp"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/scene/scene.hpp"

namespace {

using namespace windlass;
using robustness::Outcome;

robustness::Case capstan(double tension, double angle, double length, scene::ModelKind kind) {
  robustness::Case one;
  one.scene.has_cylinder = true;
  one.scene.load.tension = tension;
  one.scene.load.angle = angle;
  one.scene.rod.length = length;
  one.scene.model.kind = kind;
  return one;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cold_starts)

BOOST_AUTO_TEST_CASE(grids_reach_both_ends_of_their_ranges) {
  robustness::Grid grid;
  grid.tensions = 3;
  grid.angles = 2;
  const auto cases = robustness::grid_cases({}, grid);
  BOOST_REQUIRE_EQUAL(cases.size(), 6u);
  BOOST_TEST(std::abs(cases.front().scene.load.tension - 0.05) < 1e-15);
  BOOST_TEST(std::abs(cases.back().scene.load.tension - 1e4) < 1e-9);
  BOOST_TEST(std::abs(cases[2].scene.load.tension - std::sqrt(0.05 * 1e4)) < 1e-12);  // even in the logarithm
  BOOST_TEST(cases.back().scene.load.angle == grid.angle_high);
  for (const auto& one : cases) BOOST_TEST(one.scene.rod.length > one.scene.load.angle);
}

BOOST_AUTO_TEST_CASE(every_start_on_a_coarse_grid_is_certified) {
  // Down to 0.3 only: below 0.2839 a flat 2 pi loop is wider than the cylinder.
  robustness::Grid grid{0.3, 1e3, 0.25 * M_PI, 8.0 * M_PI, 6, 5};
  for (const auto kind : {scene::ModelKind::planar, scene::ModelKind::kirchhoff}) {
    scene::Scene scene = capstan(1.0, 1.0, 10.0, kind).scene;
    for (const auto& one : robustness::grid_cases(scene, grid)) {
      const robustness::Answer answer = robustness::try_case(one);
      BOOST_TEST_CONTEXT("T = " << one.scene.load.tension << ", phi = " << one.scene.load.angle << ": "
                                << answer.cause)
      BOOST_TEST((answer.outcome == Outcome::solved));
    }
  }
}

BOOST_AUTO_TEST_CASE(what_does_not_exist_is_said_to_be_impossible) {
  // A rod shorter than its wrap; a flat loop wider than the cylinder, which lifts off at T = 0.2839.
  const auto answer_to = [](double tension, double length) {
    return robustness::try_case(capstan(tension, 2.0 * M_PI, length, scene::ModelKind::planar));
  };
  BOOST_TEST((answer_to(1.0, 3.0).outcome == Outcome::impossible));
  const robustness::Answer lifted = answer_to(0.25, 60.0);
  BOOST_TEST((lifted.outcome == Outcome::impossible));
  BOOST_TEST(lifted.cause.find("lifts off") != std::string::npos);
  BOOST_TEST((answer_to(0.29, 60.0).outcome == Outcome::solved));
}

BOOST_AUTO_TEST_SUITE_END()
