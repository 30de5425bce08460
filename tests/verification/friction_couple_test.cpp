// The moment of the friction about the centre line, at isolated touches.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "couple_shooting.hpp"
#include "dragged_scene.hpp"
#include "observed_order.hpp"
#include "windlass/chain/guess.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;

/// A rod once round a cylinder that slides, on a plate, under a pull that leaves it on isolated touches.
scene::Scene dragged(double radius, scene::Travel travel) {
  scene::Scene scene = test::clamped_on_plate(0.3, 0.32, radius, travel);
  scene.model.tolerance = 1e-12;
  return scene;
}

/// The state that touches the plate with one tail.
equilibrium::Started state_of(const scene::Scene& scene) {
  return equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
}

double drag_of(equilibrium::Started& state) {
  return *equilibrium::record(*state.problem, state.x, state.p).F0;
}

/// On uniform meshes, from the state that the program finds.
double drag_on(const equilibrium::Started& found, const scene::Scene& scene, int stages, int elements) {
  test::OnMeshes state = test::on_uniform_meshes(found, scene, stages, elements);
  return *equilibrium::record(state.problem, state.x, found.p).F0;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(moment_of_friction)

BOOST_AUTO_TEST_CASE(agrees_with_shooting) {
  for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free})
    for (const double radius : {0.1, 2.0 / 7.0}) {
      const scene::Scene scene = dragged(radius, travel);
      equilibrium::Started state = state_of(scene);
      const equilibrium::Solution solution = equilibrium::record(*state.problem, state.x, state.p);
      const verify::Certificate certificate = verify::verify(solution, scene, {});
      BOOST_TEST(certificate.passed(), verify::to_text(certificate));
      const test::Dragged exact = test::shot_from_touches(solution, scene);
      const double travelled =
          travel == scene::Travel::free ? solution.travel_rate : solution.pull_difference;
      BOOST_TEST_MESSAGE("r " << radius << " F0 " << *solution.F0 << " off by " << *solution.F0 - exact.drag
                              << ", R_tot " << solution.R_tot << ", travelled " << travelled << " off by "
                              << travelled - exact.travelled);
      // The error of the meshes, asked for to 1e-12, and what shooting over decay lengths makes of rounding.
      BOOST_TEST(std::abs(*solution.F0 - exact.drag) < 1e-10);
      BOOST_TEST(std::abs(solution.R_tot - exact.contact_force) < 1e-10);
      BOOST_TEST(std::abs(travelled - exact.travelled) < 1e-10);
      // Along the axis, and about it where friction has no moment about it.
      BOOST_TEST(std::abs(*solution.F0 - solution.plate_force) < 1e-10);
      if (travel == scene::Travel::blocked) BOOST_TEST(solution.invariants.axial_torque_drift < 1e-10);
      // The same state is none of the scene without the moment.
      scene::Scene without = scene;
      without.motion.friction_couple = false;
      BOOST_TEST(!verify::verify(solution, without, {}).passed());
    }
}

BOOST_AUTO_TEST_CASE(tends_to_the_thin_rod_at_the_rate_of_the_radius) {
  equilibrium::Started thin = state_of(dragged(0.0, scene::Travel::blocked));
  const double none = drag_of(thin);
  const auto change = [&](double radius) {
    equilibrium::Started state = state_of(dragged(radius, scene::Travel::blocked));
    return (drag_of(state) - none) / radius;
  };
  const double far = change(0.04), near = change(0.02), nearer = change(0.01);
  BOOST_TEST_MESSAGE("dF0/dr " << far << " " << near << " " << nearer);
  BOOST_TEST(std::abs(nearer) > 1e-3);
  BOOST_TEST(std::abs((far - near) / (near - nearer) - 2.0) < 0.2);  // what is left is of first order in r
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) {
  const scene::Scene scene = dragged(2.0 / 7.0, scene::Travel::blocked);
  equilibrium::Started found = state_of(scene);
  const double exact = drag_on(found, scene, 6, 64);
  test::check_order(exact, [&](int stages, int elements) { return drag_on(found, scene, stages, elements); });
}

BOOST_AUTO_TEST_SUITE_END()
