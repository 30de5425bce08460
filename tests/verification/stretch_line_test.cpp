// Rods that stretch, dragged along a line on the cylinder: friction stretches them there, and their pressure has a layer.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "dragged_line.hpp"

using namespace windlass;
using test::state_of;

namespace {

scene::Scene stretching(double compliance, double radius = 0.0) {
  scene::Scene scene = test::lying(radius, scene::Travel::blocked);
  scene.rod.extensible = true;
  scene.rod.axial_stiffness = 1.0 / compliance;
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stretch_along_a_line)

BOOST_AUTO_TEST_CASE(agrees_with_shooting) {
  for (const auto& [compliance, radius] :
       {std::pair(1.0 / 49.0, 0.0), std::pair(0.2, 0.0), std::pair(1.0 / 49.0, 0.1)}) {
    const scene::Scene scene = stretching(compliance, radius);
    const equilibrium::Solution solution = state_of(scene);
    test::check_against_shooting(solution, scene,
                                 "1/EA " + std::to_string(compliance) + " r " + std::to_string(radius));
    // The same state is none of a rod that stretches by a little more.
    scene::Scene softer = scene;
    softer.rod.axial_stiffness /= 1.0 + 1e-5;
    BOOST_TEST(!verify::verify(solution, softer).passed());
  }
}

BOOST_AUTO_TEST_CASE(tends_to_the_rod_that_does_not_stretch_at_the_rate_1_over_EA) {
  // F0 = F + F' k + ..: of what three compliances say of F each difference is half the one before, and the last is near to F.
  const double none = *state_of(test::lying(0.0, scene::Travel::blocked)).F0;
  const double far = *state_of(stretching(0.02)).F0 - none, near = *state_of(stretching(0.01)).F0 - none,
               nearer = *state_of(stretching(0.005)).F0 - none;
  BOOST_TEST_MESSAGE("F0 - F " << far << " " << near << " " << nearer << " of " << none);
  BOOST_TEST(std::abs(near / nearer - 2.0) < 0.1);  // what is left is of second order in k: halved, too
  BOOST_TEST(std::abs(far / near - 2.0) < 0.2);
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) { test::check_order_in_layers(stretching(0.1)); }

BOOST_AUTO_TEST_SUITE_END()
