// The moment of the friction about the centre line, along a line on the cylinder.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "dragged_line.hpp"

using namespace windlass;
using test::lying;
using test::state_of;

BOOST_AUTO_TEST_SUITE(moment_of_friction_along_a_line)

BOOST_AUTO_TEST_CASE(agrees_with_shooting) {
  for (const double radius : {0.02, 0.1}) {
    const scene::Scene scene = lying(radius, scene::Travel::blocked);
    test::check_against_shooting(state_of(scene), scene, "r " + std::to_string(radius));
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
  test::check_order_in_layers(lying(0.1, scene::Travel::blocked));
}

BOOST_AUTO_TEST_SUITE_END()
