// A pull from rest ends on states known otherwise: in closed form, or by the chain of exact arcs.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/petsc_session.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/pull/outcome.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass;

namespace {

scene::Scene dragged_scene(double tension, double angle, double friction, scene::Travel travel) {
  scene::Scene scene;
  scene.name = "dragged";
  scene.has_cylinder = true;
  scene.load = {.tension = tension, .angle = angle, .thrust = {}};
  scene.rod.length = angle + 20.0;
  scene.friction = friction;
  scene.motion.sliding = scene::Sliding::up;
  scene.plate.emplace();
  scene.ends.travel = travel;
  return scene;
}

struct Pulled {
  std::vector<pull::Row> rows;
  std::optional<pull::Plateau> at;
};

Pulled pulled(const scene::Scene& scene, double h) {
  scene::Scene rest = scene;
  rest.motion = {}, rest.plate.reset(), rest.friction.reset();
  rest.second_plate.reset();
  const pull::Options options;
  pull::Pull one(pull::setting_of(scene), 0.5 * scene.rod.length, h, options);
  BOOST_REQUIRE(one.start(equilibrium::solve(rest)));
  Pulled out;
  while (!out.at && one.state().displacement < 20.0) {
    const auto row = one.advance();
    BOOST_REQUIRE(row.has_value());
    out.rows.push_back(*row);
    out.at = pull::plateau(out.rows, options);
  }
  return out;
}

}  // namespace

BOOST_FIXTURE_TEST_SUITE(pulls, test::PetscSession)

BOOST_AUTO_TEST_CASE(a_flat_coil_ends_on_the_closed_form) {
  // F = mu R_tot. Beds on meshes this coarse are off by some 1e-4 of R_tot, either way (an edge lies anywhere between
  // knots); the tails, 10 decay lengths, by nothing.
  for (const auto& [T, phi] : {std::pair{2.0, 2.0 * M_PI}, {1.5, 4.0 * M_PI}, {1.0, M_PI}}) {
    const Pulled flat = pulled(dragged_scene(T, phi, 0.32, scene::Travel::blocked), 0.1);
    BOOST_REQUIRE(flat.at.has_value());
    BOOST_TEST(std::abs(flat.at->drag / (0.32 * rod::capstan::total_force(T, phi)) - 1.0) < 1e-3);
    for (const pull::Row& row : flat.rows) {
      BOOST_TEST(std::abs(row.at.drag - row.at.plate_force) < 1e-8);   // nothing else pulls along the axis
      BOOST_TEST(row.at.drag <= 0.32 * row.at.R_tot * (1.0 + 1e-12));  // the cone, place by place
    }
    // It sticks while the elastic slip grows, then slips all at once: what moves is rigid.
    BOOST_TEST(flat.rows.front().at.sticking == 1.0);
    BOOST_TEST(flat.rows.back().at.sticking == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(a_flat_coil_that_stretches_ends_on_its_own_state) {
  // EA = 49, that of R/r = 2.5: F0 is 0.28 % below that of the rod that does not stretch; two meshes, extrapolated, tell them apart.
  scene::Scene scene = dragged_scene(1.0, 2.0 * M_PI, 0.32, scene::Travel::blocked);
  const auto limit = [&] {
    const Pulled coarse = pulled(scene, 0.2), fine = pulled(scene, 0.14);
    BOOST_REQUIRE(coarse.at.has_value());
    BOOST_REQUIRE(fine.at.has_value());
    const double ratio = std::pow(0.2 / 0.14, 3);
    return (ratio * fine.at->drag - coarse.at->drag) / (ratio - 1.0);
  };
  const double rigid = limit() / *equilibrium::solve(scene).F0;
  scene.rod.extensible = true;
  scene.rod.axial_stiffness = 49.0;
  const double elastic = limit() / *equilibrium::solve(scene).F0;
  BOOST_TEST_MESSAGE("F/F0 - 1: " << rigid - 1.0 << " without stretch, " << elastic - 1.0 << " with");
  BOOST_TEST(std::abs(rigid - 1.0) < 5e-4);
  BOOST_TEST(std::abs(elastic - 1.0) < 5e-4);
}

BOOST_AUTO_TEST_CASE(a_helix_between_two_plates_ends_on_its_steady_state) {
  // 1 apart the second plate holds the lower tail: it carries what F is short of the first one's force.
  scene::Scene scene = dragged_scene(0.57, 2.0 * M_PI, 0.1, scene::Travel::blocked);
  scene.rod.length = 30.0;
  scene.second_plate.emplace();
  scene.second_plate->side = scene::PlateSide::below;
  scene.second_plate->height = -1.0;
  const Pulled fine = pulled(scene, 0.14);
  BOOST_REQUIRE(fine.at.has_value());
  double nearest = HUGE_VAL;
  for (const auto& state : equilibrium::equilibria(scene).states)
    nearest = std::min(nearest, std::abs(fine.at->drag / *state.F0 - 1.0));
  BOOST_TEST(nearest < 1e-3);  // beds on one mesh this coarse
  const pull::Measured& at = fine.rows.back().at;
  BOOST_TEST(at.plate_force > at.drag * 1.001);
  BOOST_TEST(at.z_high - at.z_low < 1.01);
}

BOOST_AUTO_TEST_CASE(a_helix_is_dragged_to_the_steady_state_with_the_third_power_of_h) {
  // At T = 0.57 and mu = 0.1 `solve` has the flat coil and two that have left the plate; a pull comes to the stable one of
  // these, at rest along itself or running.
  for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
    const scene::Scene scene = dragged_scene(0.57, 2.0 * M_PI, 0.1, travel);
    const auto states = equilibrium::equilibria(scene).states;
    std::vector<Pulled> meshes;
    std::vector<pull::MeshOutcome> outcomes;
    for (const double h : {0.2, 0.14}) meshes.push_back(pulled(scene, h));
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      BOOST_REQUIRE(meshes[k].at.has_value());
      outcomes.push_back({k == 0 ? 0.2 : 0.14, meshes[k].rows, meshes[k].at});
    }
    const auto limit = pull::limit_of(outcomes);
    const auto chosen = pull::selected(limit->at, states, 1.0);
    BOOST_REQUIRE(chosen->state.has_value());
    BOOST_TEST(states[*chosen->state].topology != "tail line tail");  // not the flat coil
    // Two meshes, (0.2, 0.14): what is left of their errors, 7e-4 and 2e-4. The free one moves on its mesh, some 3e-5.
    BOOST_TEST(std::abs(chosen->difference) < 1e-4);
    const double F0 = *states[*chosen->state].F0;
    const double order =
        std::log((meshes[0].at->drag / F0 - 1.0) / (meshes[1].at->drag / F0 - 1.0)) / std::log(0.2 / 0.14);
    BOOST_TEST(order > 2.5);
    BOOST_TEST(order < 3.6);
  }
}

BOOST_AUTO_TEST_SUITE_END()
