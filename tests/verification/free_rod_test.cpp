// Ends, stiffnesses and natural strains of rods against values of other methods; what holds a rod against its rigid motions.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/analysis.hpp"

namespace {

using namespace windlass;
using equilibrium::Started;

scene::Scene strut(double thrust) {
  scene::Scene scene;
  scene.name = "strut";
  scene.rod.length = 1.0;
  scene.ends.kind = scene::EndKind::clamped;
  scene.load.thrust = thrust;
  scene.model.tolerance = 1e-10;
  return scene;
}

/// A short wire over a peg, phi = pi/2, touching at one place.
scene::Scene over_peg() {
  scene::Scene scene;
  scene.name = "peg";
  scene.has_cylinder = true;
  scene.rod.length = 6.0;
  scene.load.tension = 0.3;
  scene.load.angle = 0.5 * M_PI;
  return scene;
}

int index_of(const scene::Scene& scene, bool half) {
  Started start = equilibrium::cold_start(scene, true, half, {equilibrium::load_key(scene)});
  return start.problem->total_index(start.x, start.p);
}

double energy_of(const scene::Scene& scene, bool spatial) {
  Started start = equilibrium::cold_start(scene, spatial, true, {"load.tension"});
  return equilibrium::record(*start.problem, start.x, start.p).energy;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(free_rods)

// Euler's loads with the bending stiffness of each plane: clamped 4 pi^2 B n^2 and the roots of tan(kL/2) = kL/2, pinned
// pi^2 B n^2. A full chain counts what a half chain counts.
BOOST_AUTO_TEST_CASE(straight_rods_buckle_in_the_plane_of_the_lower_stiffness) {
  struct Case {
    double thrust, other_stiffness;
    scene::EndKind ends;
    int index;
  };
  using scene::EndKind;
  for (const Case& c : {Case{39.0, 1.0, EndKind::clamped, 0}, Case{60.0, 1.0, EndKind::clamped, 2},
                        Case{60.0, 2.0, EndKind::clamped, 1}, Case{78.0, 2.0, EndKind::clamped, 1},
                        Case{80.0, 2.0, EndKind::clamped, 2}, Case{82.0, 2.0, EndKind::clamped, 3},
                        Case{60.0, 0.5, EndKind::clamped, 3}, Case{9.8, 1.0, EndKind::pinned, 0},
                        Case{9.9, 1.0, EndKind::pinned, 2}, Case{9.9, 1.5, EndKind::pinned, 1},
                        Case{15.0, 1.5, EndKind::pinned, 2}})
    for (const bool half : {true, false}) {
      scene::Scene scene = strut(c.thrust);
      scene.rod.bending_stiffness_2 = c.other_stiffness;
      scene.ends.kind = c.ends;
      BOOST_TEST_CONTEXT("thrust " << c.thrust << ", B2 " << c.other_stiffness << ", half " << half)
      BOOST_TEST(index_of(scene, half) == c.index);
    }
}

// One end clamped, the other pinned: P = 20.190729 B/L^2, the first root of tan k = k squared.
BOOST_AUTO_TEST_CASE(ends_may_be_held_differently) {
  scene::Scene scene = strut(20.19);
  scene.ends.right = scene::EndKind::pinned;
  BOOST_TEST(index_of(scene, false) == 0);
  scene.load.thrust = 20.191;
  BOOST_TEST(index_of(scene, false) == 2);
}

// Energies by shooting: printed to seven decimals.
BOOST_AUTO_TEST_CASE(a_curved_wire_is_the_same_rod_in_the_plane_and_in_space) {
  const std::pair<double, double> known[] = {
      {0.0, 0.1143906}, {0.1, 0.0688383}, {0.2, 0.0357941}, {0.5, 0.0148436}, {-0.2, 0.2388763}};
  for (const auto& [curvature, energy] : known)
    for (const bool spatial : {false, true}) {
      scene::Scene scene = over_peg();
      scene.rod.natural_curvature = curvature;
      BOOST_TEST(std::abs(energy_of(scene, spatial) - energy) < 5.1e-8);
    }
  scene::Scene cable = over_peg();
  cable.rod.bending_stiffness_2 = 5.0;  // out of the plane: of no account for a flat rod
  BOOST_TEST(std::abs(energy_of(cable, true) - energy_of(over_peg(), true)) < 1e-10);
}

// d²Π/dδ² = −2 dH/dl of the flat 2 pi coil at T = 2, L = 8: the derivative of H = T cos ψ_e with the tail's length.
BOOST_AUTO_TEST_CASE(a_short_rod_slides_off_along_itself) {
  scene::Scene scene;
  scene.name = "coil";
  scene.has_cylinder = true;
  scene.rod.length = 8.0;
  scene.load.tension = 2.0;
  scene.load.angle = 2.0 * M_PI;
  for (const bool spatial : {false, true})
    for (const bool half : {true, false}) {
      Started start = equilibrium::cold_start(scene, spatial, half, {"load.tension"});
      BOOST_TEST(std::abs(start.problem->sliding_stiffness(start.x, start.p) + 0.132828) <
                 5e-7);  // known to 6 digits
      BOOST_TEST(std::abs(start.problem->chain().holding_force(start.x)) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(many_turns_of_a_straight_rod_are_exact) {
  scene::Scene scene = strut(0.0);
  scene.ends.twist = 54.0 * M_PI;
  Started start = equilibrium::cold_start(scene, true, true, {"load.thrust"});
  const equilibrium::Solution found = equilibrium::record(*start.problem, start.x, start.p);
  BOOST_TEST(std::abs(found.end_moment / (54.0 * M_PI * 2.0 / 3.0) - 1.0) < 1e-11);
}

BOOST_AUTO_TEST_SUITE_END()
