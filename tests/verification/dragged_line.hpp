#pragma once

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "couple_line_shooting.hpp"
#include "dragged_scene.hpp"
#include "observed_order.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/verify/certificate.hpp"

/// What tests of rods along a line on a cylinder that slides have in common.
namespace windlass::test {

/// A rod once round such a cylinder, with a line on it, held back by a plate that its right tail touches.
inline scene::Scene lying(double radius, scene::Travel travel) {
  scene::Scene scene = clamped_on_plate(0.45, 0.2, radius, travel);
  scene.self_contact = false;
  scene.model.tolerance = 1e-11;
  return scene;
}

inline equilibrium::Solution state_of(const scene::Scene& scene) {
  equilibrium::Started state = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
  return equilibrium::record(*state.problem, state.x, state.p);
}

/// Certified, and equal to what shooting finds. @param named  what is told of the scene
inline void check_against_shooting(const equilibrium::Solution& solution, const scene::Scene& scene,
                                   const std::string& named) {
  BOOST_TEST(solution.topology == "tail line gap touch:2 tail");
  const verify::Certificate certificate = verify::verify(solution, scene, {});
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  const Dragged exact = shot_from_line(solution, scene);
  BOOST_TEST_MESSAGE(named << " F0 " << *solution.F0 << " off by " << *solution.F0 - exact.drag << ", tau "
                           << solution.pull_difference << " off by "
                           << solution.pull_difference - exact.travelled);
  // The error of the meshes, asked for to 1e-11, and what shooting over decay lengths makes of rounding.
  BOOST_TEST(std::abs(*solution.F0 - exact.drag) < 1e-9);
  BOOST_TEST(std::abs(solution.R_tot - exact.contact_force) < 1e-9);
  BOOST_TEST(std::abs(solution.pull_difference - exact.travelled) < 1e-9);
  BOOST_TEST(std::abs(*solution.F0 - solution.plate_force) < 1e-9);
  // No point force where the pressure flows in; where it flows out one bends the free side, and lifts it off.
  BOOST_TEST(std::abs(solution.joints[2].force) < 1e-12);
  BOOST_TEST(solution.joints[1].force > 0.1);
}

/// Two and three stages on parts of the elements that the program chose, which are short in the layer.
inline void check_order_in_layers(const scene::Scene& scene) {
  const equilibrium::Started found = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
  const auto drag_on = [&](int stages, int parts) {
    std::vector<chain::ArcMesh> meshes = found.problem->meshes();
    for (chain::ArcMesh& mesh : meshes) mesh = {divided(mesh.nodes, parts), stages};
    OnMeshes state = on_meshes(found, scene, meshes);
    return *equilibrium::record(state.problem, state.x, found.p).F0;
  };
  const double exact = drag_on(6, 4);
  for (const auto& [stages, parts] : {std::pair(2, 4), std::pair(3, 2)})
    check_order(stages, parts, exact, drag_on);
}

}  // namespace windlass::test
