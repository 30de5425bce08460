// Rods that stretch while a cylinder slips along them, against what is known exactly and an integration of another kind.
#include <Eigen/Geometry>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "couple_shooting.hpp"
#include "observed_order.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;
using equilibrium::Solution;

scene::Scene soft_scene(double tension, double angle, double length, double compliance,
                        scene::Travel travel) {
  scene::Scene scene;
  scene.name = "dragged";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = angle;
  scene.rod.length = length;
  scene.rod.extensible = true;
  scene.rod.axial_stiffness = 1.0 / compliance;
  scene.friction = 0.32;
  scene.motion.sliding = scene::Sliding::up;
  scene.plate.emplace();
  scene.ends.travel = travel;
  scene.model.tolerance = 1e-12;
  return scene;
}

/// On isolated touches, one of them of the plate.
scene::Scene soft_on_touches(double compliance, scene::Travel travel) {
  scene::Scene scene = soft_scene(0.3, 2.0 * M_PI, 2.0 * M_PI + 16.0, compliance, travel);
  scene.ends.kind = scene::EndKind::clamped;
  scene.model.kind = scene::ModelKind::kirchhoff;
  return scene;
}

equilibrium::Started softened(const scene::Scene& scene) {
  return equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
}

double drag_on_softened(equilibrium::Started& state) {
  return *equilibrium::record(*state.problem, state.x, state.p).F0;
}

}  // namespace

namespace {

using Eigen::Vector3d;

/// A section of a line contact on a cylinder that slips, B = 1, with what PHYSICS, "Stretch while sliding", says of it.
struct TiltedLine {
  double k, friction, travel;
  Vector3d r, t, m, n;

  Vector3d outward() const { return Vector3d(r.x(), r.y(), 0.0).normalized(); }
  double stretch() const { return 1.0 + k * n.dot(t); }
  Vector3d slip() const { return (Vector3d::UnitZ() - travel * stretch() * t).normalized(); }
  /// n_N without friction, and w: n_N = ν − w p.
  std::pair<double, double> normal_force() const {
    const Vector3d N = outward(), across = t.cross(N);
    const double c = t.dot(Vector3d::UnitZ().cross(N)), s = t.z(), lambda = stretch();
    const double a = m.dot(t) - 3.0 * lambda * s * c, divisor = lambda * (1.0 + k * c * c * c * c);
    const double lambda_rate = -k * m.dot(N) * (a * c * c + n.dot(across)) / (1.0 + k * c * c * c * c);
    return {(m.dot(N) * a + lambda_rate * c * c) / lambda, k * friction * c * c * slip().dot(t) / divisor};
  }
  double pressure() const {
    const auto [nu, w] = normal_force();
    return (nu - n.dot(outward())) / w;
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(stretch_while_sliding)

BOOST_AUTO_TEST_CASE(a_pressure_with_the_layers_of_physics_keeps_a_rod_on_the_cylinder) {
  // The equations of the rod in space know no cylinder: with p = (ν − n_N)/w the rod stays on it. Against the layer's growth.
  TiltedLine line{0.1, 0.4, 0.25, Vector3d::UnitX(), {}, {}, {}};
  constexpr double psi = 0.5, bend = 0.2, twist = 0.1, pressed = 1.5;
  line.t = {0.0, std::cos(psi), std::sin(psi)};
  const Vector3d across = line.t.cross(line.r);
  line.n = 0.3 * across + 2.0 * line.t;
  line.m = bend * line.r - line.stretch() * std::pow(std::cos(psi), 2) * across + twist * line.t;
  const auto [nu, w] = line.normal_force();
  line.n += (nu - w * pressed) * line.r;
  BOOST_TEST(w > 0.0);
  using State = std::array<double, 12>;
  const auto rates = [&](const State& x, State& rate, double) {
    TiltedLine at = line;
    at.r = Vector3d(&x[0]), at.t = Vector3d(&x[3]), at.m = Vector3d(&x[6]), at.n = Vector3d(&x[9]);
    Eigen::Map<Vector3d>{&rate[0]} = at.stretch() * at.t;
    Eigen::Map<Vector3d>{&rate[3]} = at.m.cross(at.t);
    Eigen::Map<Vector3d>{&rate[6]} = at.stretch() * at.n.cross(at.t);
    Eigen::Map<Vector3d>{&rate[9]} = -at.pressure() * (at.outward() + at.friction * at.slip());
  };
  State x;
  Eigen::Map<Vector3d>{&x[0]} = line.r;
  Eigen::Map<Vector3d>{&x[3]} = line.t;
  Eigen::Map<Vector3d>{&x[6]} = line.m;
  Eigen::Map<Vector3d>{&x[9]} = line.n;
  boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
  constexpr int steps = 2000;
  constexpr double length = -0.4;  // 0.04 w a step
  for (int i = 0; i < steps; ++i) {
    stepper.do_step(rates, x, 0.0, length / steps);
    BOOST_TEST_REQUIRE(std::abs(std::hypot(x[0], x[1]) - 1.0) < 1e-12);
    BOOST_TEST_REQUIRE(std::abs(x[0] * x[3] + x[1] * x[4]) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_flat_coil_is_dragged_with_the_force_of_the_closed_form) {
  // PHYSICS, "Planar capstan that stretches". Tails of 20 decay lengths: exp(−2 √T L_tail) is below the bound.
  for (const double angle : {0.75 * M_PI, M_PI, 1.5 * M_PI, 2.0 * M_PI, 4.0 * M_PI})
    for (const double T : {1.0, 3.0})
      for (const double k : {0.02, 0.2})
        for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
          const scene::Scene scene = soft_scene(T, angle, angle + 40.0 / std::sqrt(T), k, travel);
          equilibrium::Started state = softened(scene);
          const Solution flat = equilibrium::record(*state.problem, state.x, state.p);
          const double stretch = (1.0 + k * T) / std::sqrt(1.0 + k), tension = (stretch - 1.0) / k,
                       beta = std::acos(tension / T);
          const double exact = 2.0 * (tension * (0.5 * angle - beta) + T * std::sin(beta));
          BOOST_TEST_CONTEXT("phi = " << angle << ", T = " << T << ", 1/EA = " << k
                                      << ", F0 = " << *flat.F0) {
            BOOST_TEST(flat.topology == "tail line tail");
            BOOST_TEST(std::abs(*flat.F0 - 0.32 * exact) < 1e-10 * exact);
            BOOST_TEST(std::abs(flat.plate_force - 0.32 * flat.R_tot) < 1e-12 * exact);
            BOOST_TEST(std::abs(flat.travel_rate) + std::abs(flat.pull_difference) < 1e-12);
            const verify::Certificate certificate = verify::verify(flat, scene);
            BOOST_TEST(certificate.passed(), verify::to_text(certificate));
          }
        }
}

BOOST_AUTO_TEST_CASE(touches_agree_with_shooting) {
  for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free})
    for (const double k : {1.0 / 49.0, 0.2})
      for (const double arm : {0.0, 2.0 / 7.0}) {
        scene::Scene scene = soft_on_touches(k, travel);
        scene.rod_radius = arm;
        equilibrium::Started state = softened(scene);
        const Solution solution = equilibrium::record(*state.problem, state.x, state.p);
        const verify::Certificate certificate = verify::verify(solution, scene);
        BOOST_TEST(certificate.passed(), verify::to_text(certificate));
        const test::Dragged exact = test::shot_from_touches(solution, scene);
        const double travelled =
            travel == scene::Travel::free ? solution.travel_rate : solution.pull_difference;
        BOOST_TEST_MESSAGE("1/EA " << k << " arm " << arm << " F0 " << *solution.F0 << " off by "
                                   << *solution.F0 - exact.drag << ", travelled " << travelled << " off by "
                                   << travelled - exact.travelled);
        // The error of the meshes, asked for to 1e-12, and what shooting over decay lengths makes of rounding.
        BOOST_TEST(std::abs(*solution.F0 - exact.drag) < 1e-10);
        BOOST_TEST(std::abs(solution.R_tot - exact.contact_force) < 1e-10);
        BOOST_TEST(std::abs(travelled - exact.travelled) < 1e-10);
        BOOST_TEST(std::abs(*solution.F0 - solution.plate_force) < 1e-10);
        BOOST_TEST(solution.stretch > 0.25 * k);
        // The same state is none of a rod that stretches by a little more.
        scene::Scene softer = scene;
        softer.rod.axial_stiffness /= 1.0 + 1e-6;
        BOOST_TEST(!verify::verify(solution, softer).passed());
      }
}

BOOST_AUTO_TEST_CASE(a_stiff_rod_tends_to_the_one_that_does_not_stretch_at_the_rate_1_over_EA) {
  scene::Scene rigid = soft_on_touches(1.0, scene::Travel::free);
  rigid.rod.extensible = false;
  rigid.rod.axial_stiffness = HUGE_VAL;
  equilibrium::Started limit = softened(rigid);
  const double none = drag_on_softened(limit);
  std::vector<double> slopes;
  for (const double k : {0.04, 0.004, 0.0004}) {
    equilibrium::Started state = softened(soft_on_touches(k, scene::Travel::free));
    slopes.push_back((drag_on_softened(state) - none) / k);
  }
  BOOST_TEST_MESSAGE("dF0/dk " << slopes[0] << " " << slopes[1] << " " << slopes[2]);
  BOOST_TEST(std::abs(slopes[2]) > 1e-3);
  // What is left falls with k, too.
  BOOST_TEST((slopes[0] - slopes[1]) / (slopes[1] - slopes[2]) == 10.0, boost::test_tools::tolerance(0.2));
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) {
  const scene::Scene scene = soft_on_touches(0.1, scene::Travel::free);
  equilibrium::Started found = softened(scene);
  const auto drag = [&](int stages, int elements) {
    test::OnMeshes state = test::on_uniform_meshes(found, scene, stages, elements);
    return *equilibrium::record(state.problem, state.x, found.p).F0;
  };
  test::check_order(drag(6, 64), drag);
}

BOOST_AUTO_TEST_CASE(lines_of_a_rod_that_runs_along_itself_are_refused) {
  // A one-handed state at little friction, with lines on the cylinder that are no circles.
  const auto tilted = [](scene::Travel travel) {
    scene::Scene scene = soft_scene(1.01, 2.0 * M_PI, 2.0 * M_PI + 8.0, 0.02, travel);
    scene.friction = 0.005;
    scene.model.kind = scene::ModelKind::kirchhoff;
    scene.model.tolerance = 1e-9;
    return scene;
  };
  const scene::Scene blocked = tilted(scene::Travel::blocked);
  equilibrium::Started state = softened(blocked);
  const Solution solution = equilibrium::record(*state.problem, state.x, state.p);
  const verify::Certificate certificate = verify::verify(solution, blocked);
  BOOST_TEST_MESSAGE(solution.topology);
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  try {
    softened(tilted(scene::Travel::free));
    BOOST_ERROR("it was not refused");
  } catch (const equilibrium::NoEquilibrium& none) {
    BOOST_TEST_MESSAGE(none.what());
    BOOST_TEST(std::string(none.what()).find("rod.extensible") != std::string::npos, none.what());
  }
}

BOOST_AUTO_TEST_SUITE_END()
