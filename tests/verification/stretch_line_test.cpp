// Rods that stretch, dragged along a line on the cylinder: friction stretches them there, and their pressure has a layer.
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
scene::Scene lying(double compliance, double radius = 0.0) {
  scene::Scene scene = test::clamped_on_plate(0.45, 0.2, radius, scene::Travel::blocked);
  scene.self_contact = false;
  scene.rod.extensible = true;
  scene.rod.axial_stiffness = 1.0 / compliance;
  scene.model.tolerance = 1e-11;
  return scene;
}

equilibrium::Solution state_of(const scene::Scene& scene) {
  equilibrium::Started state = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
  return equilibrium::record(*state.problem, state.x, state.p);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stretch_along_a_line)

BOOST_AUTO_TEST_CASE(agrees_with_shooting) {
  for (const auto& [compliance, radius] :
       {std::pair(1.0 / 49.0, 0.0), std::pair(0.2, 0.0), std::pair(1.0 / 49.0, 0.1)}) {
    const scene::Scene scene = lying(compliance, radius);
    const equilibrium::Solution solution = state_of(scene);
    BOOST_TEST(solution.topology == "tail line gap touch:2 tail");
    const verify::Certificate certificate = verify::verify(solution, scene, {});
    BOOST_TEST(certificate.passed(), verify::to_text(certificate));
    const test::Dragged exact = test::shot_from_line(solution, scene);
    BOOST_TEST_MESSAGE("1/EA " << compliance << " r " << radius << " F0 " << *solution.F0 << " off by "
                               << *solution.F0 - exact.drag << ", tau " << solution.pull_difference
                               << " off by " << solution.pull_difference - exact.travelled);
    // The error of the meshes, asked for to 1e-11, and what shooting over decay lengths makes of rounding.
    BOOST_TEST(std::abs(*solution.F0 - exact.drag) < 1e-9);
    BOOST_TEST(std::abs(solution.R_tot - exact.contact_force) < 1e-9);
    BOOST_TEST(std::abs(solution.pull_difference - exact.travelled) < 1e-9);
    BOOST_TEST(std::abs(*solution.F0 - solution.plate_force) < 1e-9);
    // No point force where the pressure flows in; where it flows out one stretches the free side, and lifts it off.
    BOOST_TEST(std::abs(solution.joints[2].force) < 1e-12);
    BOOST_TEST(solution.joints[1].force > 0.1);
    // The same state is none of a rod that stretches by a little more.
    scene::Scene softer = scene;
    softer.rod.axial_stiffness /= 1.0 + 1e-5;
    BOOST_TEST(!verify::verify(solution, softer).passed());
  }
}

BOOST_AUTO_TEST_CASE(tends_to_the_rod_that_does_not_stretch_at_the_rate_1_over_EA) {
  // F0 = F + F' k + ..: of what three compliances say of F each difference is half the one before, and the last is near to F.
  scene::Scene rigid = lying(1.0);
  rigid.rod.extensible = false;
  rigid.rod.axial_stiffness = HUGE_VAL;
  const double none = *state_of(rigid).F0;
  const double far = *state_of(lying(0.02)).F0 - none, near = *state_of(lying(0.01)).F0 - none,
               nearer = *state_of(lying(0.005)).F0 - none;
  BOOST_TEST_MESSAGE("F0 - F " << far << " " << near << " " << nearer << " of " << none);
  BOOST_TEST(std::abs(near / nearer - 2.0) < 0.1);  // what is left is of second order in k: halved, too
  BOOST_TEST(std::abs(far / near - 2.0) < 0.2);
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) {
  // On parts of the elements that the program chose, which are short in the layer.
  const scene::Scene scene = lying(0.1);
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
