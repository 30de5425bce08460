#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "windlass/scene/units.hpp"

using namespace windlass::scene;
using std::numbers::pi;
namespace tt = boost::test_tools;

BOOST_AUTO_TEST_SUITE(scene_units)

BOOST_AUTO_TEST_CASE(angles_in_every_spelling) {
  const std::pair<const char*, double> cases[] = {
      {"2 pi", 2 * pi},    {"2pi", 2 * pi},          {"2 * pi", 2 * pi}, {"pi", pi},
      {"pi/2", pi / 2},    {"3 pi / 4", 3 * pi / 4}, {"-pi/4", -pi / 4}, {"90 deg", pi / 2},
      {"90°", pi / 2},     {"1 turn", 2 * pi},       {"1.5", 1.5},       {"1.5 rad", 1.5},
      {"  2  pi ", 2 * pi}};
  for (const auto& [text, expected] : cases)
    BOOST_TEST(parse_angle(text) == expected, tt::tolerance(1e-15) << text);
}

BOOST_AUTO_TEST_CASE(what_is_no_angle_is_refused) {
  for (const char* text :
       {"", " ", "two pi", "2 pie", "pi pi", "/2", "2 *", "pi/0", "pi/", "4 mm", "inf", "nan"})
    BOOST_CHECK_THROW(parse_angle(text), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(quantities_become_si) {
  BOOST_TEST(parse_quantity("4 mm", Dimension::length) == 4e-3, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("0.1um", Dimension::length) == 1e-7, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("1.2 MPa", Dimension::modulus) == 1.2e6, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("0.4e-3 N m^2", Dimension::stiffness) == 4e-4, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("0.4e-3 N m²", Dimension::stiffness) == 4e-4, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("20 1/m", Dimension::curvature) == 20.0, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("2 rad/mm", Dimension::curvature) == 2000.0, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("-3 N", Dimension::force) == -3.0, tt::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(a_mass_is_a_hung_mass) {
  BOOST_TEST(parse_quantity("500 g", Dimension::force) == 0.5 * 9.80665, tt::tolerance(1e-15));
  BOOST_TEST(parse_quantity("10 kg", Dimension::force) == 98.0665, tt::tolerance(1e-15));
  BOOST_CHECK_THROW(parse_quantity("500 g", Dimension::length), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_wrong_unit_says_what_is_allowed) {
  const auto message = [](const char* text, Dimension dimension) -> std::string {
    try {
      parse_quantity(text, dimension);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  BOOST_TEST(message("4 N", Dimension::length) == "must be a length such as \"4 mm\"");
  BOOST_TEST(message("4", Dimension::length) == "must be a length such as \"4 mm\"");
  BOOST_TEST(message("mm", Dimension::length) == "must be a length such as \"4 mm\"");
  BOOST_TEST(message("4 furlonks", Dimension::length) ==
             "\"furlonks\" is not a known unit; must be a length such as \"4 mm\"");
}

BOOST_AUTO_TEST_CASE(scales_follow_from_length_and_stiffness) {
  const Units units = Units::of(0.014, 2.4e-4);
  BOOST_TEST(units.force == 2.4e-4 / 0.014 / 0.014, tt::tolerance(1e-15));
  BOOST_TEST(units.moment == units.force * 0.014, tt::tolerance(1e-15));
  BOOST_TEST(units.pressure * 0.014 == units.force, tt::tolerance(1e-15));
  BOOST_TEST(units.energy == units.moment);
  BOOST_TEST(scale_of(units, Dimension::curvature) * scale_of(units, Dimension::length) == 1.0);
  BOOST_TEST(scale_of(units, Dimension::none) == 1.0);
}

BOOST_AUTO_TEST_CASE(a_scene_in_natural_units_is_the_same_scene) {
  Scene scene;  // a strut
  scene.rod.length = 8.0;
  scene.rod.bending_stiffness = 0.5;
  scene.rod.bending_stiffness_2 = 2.0;
  scene.rod.natural_curvature = 0.25;
  scene.load.thrust = 3.0;
  scene.walls.push_back({{0.0, 1.0, 0.0}, 0.4});
  scene.continuation = Continuation{.parameter = "load.thrust", .from = 1.0, .to = 3.0};
  const Scene solved = natural(scene);
  BOOST_TEST(solved.rod.length == 1.0);
  BOOST_TEST(solved.rod.bending_stiffness == 1.0);
  BOOST_TEST(solved.rod.bending_stiffness_2 == 4.0);
  BOOST_TEST(solved.rod.natural_curvature == 2.0);
  BOOST_TEST(*solved.load.thrust == 3.0 * 64.0 / 0.5);  // P L²/B
  BOOST_TEST(solved.continuation->to == *solved.load.thrust);
  BOOST_TEST(solved.walls[0].distance == 0.05);
  BOOST_TEST((as_given(solved) == scene));  // powers of two: no rounding
  BOOST_TEST(as_given(solved, "load.thrust", solved.continuation->from) == 1.0);
  BOOST_TEST((natural(solved) == solved));
}

BOOST_AUTO_TEST_SUITE_END()
