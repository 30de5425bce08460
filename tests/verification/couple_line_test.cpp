// The moment of the friction about the centre line, along a line on the cylinder.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "couple_line_shooting.hpp"
#include "dragged_scene.hpp"
#include "observed_order.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;

/// A rod once round a cylinder that slides, with a line on it, held back by a plate that its right tail touches.
scene::Scene lying(double radius, scene::Travel travel) {
  scene::Scene scene = test::clamped_on_plate(0.45, 0.2, radius, travel);
  scene.self_contact = false;
  scene.model.tolerance = 1e-11;
  return scene;
}

equilibrium::Solution state_of(const scene::Scene& scene) {
  equilibrium::Started state = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
  return equilibrium::record(*state.problem, state.x, state.p);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(moment_of_friction_along_a_line)

BOOST_AUTO_TEST_CASE(agrees_with_shooting) {
  for (const double radius : {0.02, 0.1}) {
    const scene::Scene scene = lying(radius, scene::Travel::blocked);
    const equilibrium::Solution solution = state_of(scene);
    BOOST_TEST(solution.topology == "tail line gap touch:2 tail");
    const verify::Certificate certificate = verify::verify(solution, scene, {});
    BOOST_TEST(certificate.passed(), verify::to_text(certificate));
    const test::Dragged exact = test::shot_from_line(solution, scene);
    BOOST_TEST_MESSAGE("r " << radius << " F0 " << *solution.F0 << " off by " << *solution.F0 - exact.drag
                            << ", tau " << solution.pull_difference << " off by "
                            << solution.pull_difference - exact.travelled);
    // The error of the meshes, asked for to 1e-11, and what shooting over decay lengths makes of rounding.
    BOOST_TEST(std::abs(*solution.F0 - exact.drag) < 1e-9);
    BOOST_TEST(std::abs(solution.R_tot - exact.contact_force) < 1e-9);
    BOOST_TEST(std::abs(solution.pull_difference - exact.travelled) < 1e-9);
    BOOST_TEST(std::abs(*solution.F0 - solution.plate_force) < 1e-9);
    // No point force where the pressure flows in; what the moment jumps by where it flows out lifts the rod off.
    BOOST_TEST(std::abs(solution.joints[2].force) < 1e-12);
    BOOST_TEST(solution.joints[1].force > 0.1);
  }
}

BOOST_AUTO_TEST_CASE(tends_to_the_line_without_moment_at_the_rate_of_the_radius) {
  // F0 = F + F' r + ..: of what three radii say of F each difference is half the one before, and the last is near to F.
  for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
    scene::Scene without = lying(0.01, travel);
    without.motion.friction_couple = false;
    const double none = *state_of(without).F0;
    const double far = *state_of(lying(0.04, travel)).F0 - none,
                 near = *state_of(lying(0.02, travel)).F0 - none,
                 nearer = *state_of(lying(0.01, travel)).F0 - none;
    BOOST_TEST_MESSAGE("F0 - F " << far << " " << near << " " << nearer << " of " << none);
    BOOST_TEST(std::abs(near / nearer - 2.0) < 0.25);  // what is left is of second order in r: halved, too
    BOOST_TEST(std::abs(far / near - 2.0) < 0.5);
  }
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) {
  // On parts of the elements that the program chose, which are short in the layer.
  const scene::Scene scene = lying(0.1, scene::Travel::blocked);
  const equilibrium::Started found = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
  const auto drag_on = [&](int stages, int parts) {
    std::vector<chain::ArcMesh> meshes = found.problem->meshes();
    for (chain::ArcMesh& mesh : meshes) mesh = {test::divided(mesh.nodes, parts), stages};
    test::OnMeshes state = test::on_meshes(found, scene, meshes);
    return *equilibrium::record(state.problem, state.x, found.p).F0;
  };
  const double exact = drag_on(6, 4);
  for (const auto& [stages, parts] : {std::pair(2, 4), std::pair(3, 2)})
    test::check_order(stages, parts, exact, drag_on);
}

BOOST_AUTO_TEST_SUITE_END()
