// A plate's outer edge against differences, and against the distances that it stands for.
#include "windlass/obstacle/rim.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/obstacle/scene_obstacles.hpp"

namespace {

using namespace windlass;
using namespace windlass::obstacle;

constexpr double radius = 1.3, height = 0.2;

}  // namespace

BOOST_AUTO_TEST_SUITE(rims)

BOOST_AUTO_TEST_CASE(the_gap_is_the_distance_from_a_plate_that_ends) {
  constexpr double h = 1e-5, bound = 1e-9;  // central differences of quantities of order one
  for (const bool above : {true, false})
    for (const double tube : {0.0, 0.25}) {
      const Rim rim(radius, height, above, tube);
      const double side = above ? -1.0 : 1.0;  // of the rod
      const auto at = [&](double outside, double off) {
        const double distance = radius + outside;
        return Vector3d(0.6 * distance, -0.8 * distance, height - side * tube + side * off);
      };
      BOOST_TEST(std::abs(rim.gap(at(-0.2, 0.5)) - (0.5 - tube)) < 1e-15);  // the plane
      BOOST_TEST(std::abs(rim.gap(at(0.3, 0.4)) - (0.5 - tube)) < 1e-15);   // the edge
      BOOST_TEST(std::abs(rim.gap(at(0.3, -0.4)) - (0.3 - tube)) < 1e-15);  // the outer side
      for (const Vector3d& r : {at(-0.2, 0.5), at(0.3, 0.4), at(0.3, -0.4)})
        for (int k = 0; k < 3; ++k) {
          const Vector3d step = h * Vector3d::Unit(k);
          const double slope = (rim.gap(r + step) - rim.gap(r - step)) / (2 * h);
          BOOST_TEST(std::abs(slope - rim.normal(r)(k)) < bound);
          const Vector3d bend = (rim.normal(r + step) - rim.normal(r - step)) / (2 * h);
          BOOST_TEST((bend - rim.hessian(r).col(k)).norm() < bound);
        }
    }
}

BOOST_AUTO_TEST_CASE(the_chart_lies_on_it) {
  const Vector2d u(0.4, 0.7);
  for (const bool above : {true, false}) {
    const Rim rim(radius, height, above, 0.25);
    const Chart at = rim.chart(u);
    BOOST_TEST(std::abs(rim.gap(at.r)) < 1e-15);
    BOOST_TEST((at.normal - rim.normal(at.r)).norm() < 1e-14);
    BOOST_TEST((rim.coordinates(at.r, 0.3) - u).norm() < 1e-14);
    // The curvature that the gap has along the tangents is that of the chart.
    const Eigen::Matrix2d bend = at.tangents.transpose() * rim.hessian(at.r) * at.tangents;
    BOOST_TEST((bend - at.bend).norm() < 1e-13);
    const Vector3d t = Eigen::AngleAxisd(0.8, at.normal) * at.tangents.col(1);
    BOOST_TEST(std::abs(rim.tilt(at.r, t) - u(1)) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(a_plate_that_ends_has_one) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.plate = scene::Plate{};
  BOOST_TEST(obstacles_of(scene).size() == 2);
  scene.plate->outer_radius = radius;
  scene.rod_radius = 0.1;
  const Set all = obstacles_of(scene);
  BOOST_REQUIRE(all.size() == 3);
  BOOST_REQUIRE(as_rim(all.pointer(2)));
  BOOST_TEST(as_rim(all.pointer(2))->tube() == 0.1);
  BOOST_TEST(!as_rim(all.pointer(1)));
}

BOOST_AUTO_TEST_CASE(two_plates_come_one_after_the_other_each_with_its_edge) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.plate = scene::Plate{.height = 0.2, .side = scene::PlateSide::above, .outer_radius = radius};
  scene.second_plate = scene::Plate{.height = -0.7, .side = scene::PlateSide::below};
  const Set all = obstacles_of(scene);
  BOOST_REQUIRE(all.size() == 4);
  BOOST_TEST(as_rim(all.pointer(2)));
  const Vector3d between(1.1, 0.0, -0.3);  // gaps are distances from either
  BOOST_TEST(std::abs(all[1].gap(between) - 0.5) < 1e-15);
  BOOST_TEST(std::abs(all[3].gap(between) - 0.4) < 1e-15);
  BOOST_TEST(all[3].normal(between) == Vector3d::UnitZ());
  const std::vector<int> plates{0, 1, 1, 2, 0};
  for (int o = 0; o < 5; ++o) BOOST_TEST(plate_at(scene, o) == plates[o]);
}

BOOST_AUTO_TEST_SUITE_END()
