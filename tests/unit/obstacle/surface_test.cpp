// Each obstacle's gap, normal, Hessian and chart against differences and against each other.
#include "windlass/obstacle/surface.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/obstacle/plane.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"

namespace {

using namespace windlass;
using namespace windlass::obstacle;

constexpr double h = 1e-5;      // central differences: h² and 1e-16/h,
constexpr double bound = 1e-9;  // quantities of order one

const std::vector<std::pair<const char*, SurfacePointer>>& all() {
  static const std::vector<std::pair<const char*, SurfacePointer>> surfaces = {
      {"cylinder", unit_cylinder()},
      {"wall above", std::make_shared<Plane>(Vector3d(0.0, 2.0, 0.0), 0.3)},
      {"wall below", std::make_shared<Plane>(Vector3d(0.0, -1.0, 0.0), 0.3)},
      {"oblique wall", std::make_shared<Plane>(Vector3d(0.3, -0.5, 0.8), 0.7)},
      {"wall across", std::make_shared<Plane>(Vector3d(1.0, 0.0, 0.0), 0.7)},
  };
  return surfaces;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(surfaces)

BOOST_AUTO_TEST_CASE(normal_and_hessian_are_the_derivatives_of_the_gap) {
  const Vector3d r(0.7, -1.1, 0.4);
  for (const auto& [name, surface] : all())
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = h * Vector3d::Unit(k), up = r + step, down = r - step;
      BOOST_TEST(std::abs((surface->gap(up) - surface->gap(down)) / (2 * h) - surface->normal(r)(k)) < bound,
                 name);
      BOOST_TEST(
          ((surface->normal(up) - surface->normal(down)) / (2 * h) - surface->hessian(r).col(k)).norm() <
              bound,
          name);
    }
}

BOOST_AUTO_TEST_CASE(the_chart_lies_on_the_surface_and_is_isometric) {
  const Vector2d u(0.4, -0.3);
  for (const auto& [name, surface] : all()) {
    const Chart at = surface->chart(u);
    BOOST_TEST(std::abs(surface->gap(at.r)) < 1e-15, name);
    BOOST_TEST((at.normal - surface->normal(at.r)).norm() < 1e-15, name);
    BOOST_TEST((at.tangents.transpose() * at.tangents - Eigen::Matrix2d::Identity()).norm() < 1e-15, name);
    const Vector3d first = at.tangents.col(0), second = at.tangents.col(1);
    BOOST_TEST((first.cross(second) - at.normal).norm() < 1e-15, name);
    const double turn = std::atan2(at.r.x(), -at.r.y());
    BOOST_TEST((surface->coordinates(at.r, turn) - u).norm() < 1e-15, name);
    BOOST_TEST(std::abs(surface->turn(u) - turn) < 1e-15, name);
    BOOST_TEST(at.bend(0, 0) == surface->curvature(), name);
  }
}

BOOST_AUTO_TEST_CASE(derivatives_of_the_chart) {
  const Vector2d u(0.4, -0.3);
  const Vector3d f(0.3, -0.8, 0.5);
  for (const auto& [name, surface] : all()) {
    const Chart at = surface->chart(u);
    for (int i = 0; i < 2; ++i) {
      const Vector2d step = h * Vector2d::Unit(i);
      const Chart up = surface->chart(u + step), down = surface->chart(u - step);
      BOOST_TEST(((up.r - down.r) / (2 * h) - at.tangents.col(i)).norm() < bound, name);
      BOOST_TEST(std::abs(f.dot(up.normal - down.normal) / (2 * h) - at.normal_slope(f)(i)) < bound, name);
      for (int j = 0; j < 2; ++j)
        BOOST_TEST(
            std::abs(f.dot(up.tangents.col(j) - down.tangents.col(j)) / (2 * h) - at.second(f)(i, j)) < bound,
            name);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_rise_keeps_its_digits) {
  const Vector2d u(0.4, -0.3);
  for (const auto& [name, surface] : all()) {
    const Vector2d large(0.2, 0.1), small(3e-13, -2e-13);
    const Vector3d rise = surface->rise(u, large);
    BOOST_TEST((rise - (surface->chart(u + large).r - surface->chart(u).r)).norm() < 1e-15, name);
    BOOST_TEST((surface->rise(u, small) - surface->chart(u).tangents * small).norm() < 1e-24,
               name);  // second order
  }
}

BOOST_AUTO_TEST_CASE(the_base_frame_lies_along_the_chart) {
  const Vector2d u(2.9, -0.3);
  for (const auto& [name, surface] : all()) {
    const Quaternion q = surface->base_frame(u);
    const Matrix3d d = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
    const Chart at = surface->chart(u);
    Matrix3d expected;
    expected << at.normal, -at.tangents.col(1), at.tangents.col(0);
    BOOST_TEST((d - expected).norm() < 1e-14, name);
  }
}

BOOST_AUTO_TEST_CASE(a_sheet_lies_on_its_wall) {
  const Eigen::AlignedBox3d box(Vector3d(-0.5, -0.1, 0.0), Vector3d(0.5, 0.2, 0.0));
  for (const auto& [name, surface] : all()) {
    const std::vector<Vector3d> corners = surface->sheet(box);
    BOOST_TEST(corners.size() == (surface->curvature() == 0.0 ? 4u : 0u), name);
    for (const Vector3d& corner : corners) BOOST_TEST(std::abs(surface->gap(corner)) < 1e-15, name);
  }
}

BOOST_AUTO_TEST_CASE(obstacles_of_scenes) {
  scene::Scene scene;
  BOOST_TEST(obstacles_of(scene).size() == 0);
  scene.walls = {{{0.0, 3.0, 0.0}, 0.1}, {{0.0, -1.0, 0.0}, 0.2}};
  const Set walls = obstacles_of(scene);
  BOOST_TEST(walls.size() == 2);
  BOOST_TEST(walls[0].gap({0.4, 0.03, 0.0}) == 0.07, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(walls[1].gap({0.4, 0.03, 0.0}) == 0.23, boost::test_tools::tolerance(1e-14));
  scene.has_cylinder = true;
  BOOST_TEST(obstacles_of(scene).size() == 1);
  BOOST_TEST(obstacles_of(scene)[0].curvature() == 1.0);
}

BOOST_AUTO_TEST_SUITE_END()
