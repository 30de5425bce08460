// Ends on sliders: against the closed form where nothing holds them, and against shooting in the plane.
#include <Eigen/LU>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;
using Eigen::Vector3d;
using equilibrium::Solution;

scene::Scene on_sliders(double tension, double angle, double length) {
  scene::Scene scene;
  scene.name = "sliders";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = angle;
  scene.rod.length = length;
  scene.ends.guide = scene::Guide::slider;
  scene.model.tolerance = 1e-12;
  return scene;
}

Solution between_sliders(const scene::Scene& scene, bool half = true) {
  equilibrium::Started started = equilibrium::cold_start(scene, true, half, {"load.tension"});
  return equilibrium::record(*started.problem, started.x, started.p);
}

/// What the right slider holds its end with, outward from the axis.
double across(const Solution& s) {
  const Vector3d outward(std::sin(0.5 * s.phi), -std::cos(0.5 * s.phi), 0.0);
  return outward.dot(Vector3d(s.arcs.back().n.rightCols<1>()));
}

struct Flat {
  double R_tot, across;
};

/// Half of the flat coil, B = 1: round the circle to the angle a with the tension t, λ = 1 + k t, m = λ, then θ' = m, m' = λ n × t,
/// r' = λ t from the edge, where a point force f acts, to the end. a, t and f by Newton's method, from r·N = c, n·e = T, and θ or m there.
Flat shot(const scene::Scene& scene, Eigen::Vector3d x) {
  const double k = scene.rod.compliance(), half = 0.5 * scene.load.angle, T = scene.load.tension;
  const Eigen::Vector2d e(std::cos(half), std::sin(half)), outward(std::sin(half), -std::cos(half));
  const bool clamped = scene.ends.kind == scene::EndKind::clamped;
  Eigen::Vector2d n;
  const auto off = [&](const Eigen::Vector3d& at) {
    using State = std::array<double, 4>;  // x, y, θ, m
    const double a = at(0), stretch = 1.0 + k * at(1), length = 0.5 * scene.rod.length - a / stretch;
    n = at(1) * Eigen::Vector2d(std::cos(a), std::sin(a)) -
        at(2) * Eigen::Vector2d(std::sin(a), -std::cos(a));
    // The force on the rod is outward: what is before the edge less what is behind it.
    State s{std::sin(a), -std::cos(a), a, stretch};
    const auto rates = [&](const State& y, State& rate, double) {
      const double c = std::cos(y[2]), d = std::sin(y[2]), along = 1.0 + k * (n(0) * c + n(1) * d);
      rate = {along * c, along * d, y[3], along * (n(0) * d - n(1) * c)};
    };
    boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i) stepper.do_step(rates, s, 0.0, length / steps);
    const double bend = clamped ? s[2] - half : s[3];
    return Eigen::Vector3d(s[0] * outward(0) + s[1] * outward(1) - scene.ends.guide_offset, n.dot(e) - T,
                           bend);
  };
  for (int i = 0; i < 30; ++i) {
    Eigen::Matrix3d j;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(c);
      j.col(c) = (off(x + step) - off(x - step)) / 2e-6;
    }
    const Eigen::Vector3d dx = -j.fullPivLu().solve(off(x));
    x += dx;
    if (dx.norm() > 1e-12) continue;
    off(x);
    return {2.0 * (x(1) * x(0) + x(2)), n.dot(outward)};
  }
  BOOST_FAIL("the oracle did not converge");
  return {};
}

/// Near it: edge, tension and point force of the state itself, moved a little.
Eigen::Vector3d near(const Solution& s) {
  constexpr double off = 1e-5;  // grows by exp(√T L_tail)
  const auto& line = s.arcs[1];
  const Vector3d t(std::cos(s.phi_star), std::sin(s.phi_star), 0.0);
  return {s.phi_star + off, Vector3d(line.n.rightCols<1>()).dot(t) - off, s.joints[2].force + off};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(ends_on_sliders)

BOOST_AUTO_TEST_CASE(where_a_long_tail_runs_by_itself_nothing_holds_it) {
  for (const double angle : {M_PI, 2.0 * M_PI})
    for (const double T : {0.8, 3.0}) {
      scene::Scene scene = on_sliders(T, angle, angle + 40.0 / std::sqrt(T));
      scene.ends.guide_offset = 1.0 + 0.5 / T;
      const Solution s = between_sliders(scene);
      const double exact = rod::capstan::total_force(T, angle);
      BOOST_TEST_CONTEXT("phi = " << angle << ", T = " << T << ", R_tot = " << s.R_tot << ", " << across(s)) {
        BOOST_TEST(std::abs(s.R_tot / exact - 1.0) < 1e-9);
        BOOST_TEST(std::abs(across(s)) < 1e-9);
      }
    }
}

BOOST_AUTO_TEST_CASE(flat_coils_agree_with_shooting) {
  for (const scene::EndKind kind : {scene::EndKind::moment_free, scene::EndKind::clamped})
    for (const double k : {0.0, 0.05})
      for (const double offset : {1.0, 1.6}) {
        scene::Scene scene = on_sliders(2.0, 2.0 * M_PI, 2.0 * M_PI + 8.0);
        scene.ends.kind = kind;
        scene.ends.guide_offset = offset;
        scene.rod.extensible = k != 0.0;
        if (k != 0.0) scene.rod.axial_stiffness = 1.0 / k;
        const Solution s = between_sliders(scene);
        BOOST_REQUIRE(s.topology == "tail line tail");
        const Flat exact = shot(scene, near(s));
        BOOST_TEST_CONTEXT("clamped " << (kind == scene::EndKind::clamped) << ", 1/EA = " << k << ", offset "
                                      << offset << ": R_tot = " << s.R_tot << ", across " << across(s)) {
          BOOST_TEST_MESSAGE("R_tot " << s.R_tot << " off by " << s.R_tot - exact.R_tot << ", across "
                                      << across(s) << " off by " << across(s) - exact.across);
          BOOST_TEST(std::abs(s.R_tot - exact.R_tot) < 1e-10);
          BOOST_TEST(std::abs(across(s) - exact.across) < 1e-10);
          BOOST_TEST(std::abs(across(s)) > 1e-3);
          const verify::Certificate certificate = verify::verify(s, scene);
          BOOST_TEST(certificate.passed(), verify::to_text(certificate));
          BOOST_TEST(certificate.find("end_guide") != nullptr);
          scene::Scene elsewhere = scene;
          elsewhere.ends.guide_offset += 1e-6;
          BOOST_TEST(!verify::verify(s, elsewhere).passed());
        }
      }
}

BOOST_AUTO_TEST_CASE(a_helix_between_sliders_is_certified_on_whole_and_half_chains) {
  // Below the flat coil's stability limit: the rod leaves the plane, and sliders hold its ends in it.
  scene::Scene scene = on_sliders(0.65, 2.0 * M_PI, 2.0 * M_PI + 16.0);
  scene.ends.kind = scene::EndKind::clamped;
  scene.model.tolerance = 1e-10;
  const Solution half = equilibrium::solve(scene);
  BOOST_TEST(std::abs(half.tilt) > 0.1);
  const verify::Certificate certificate = verify::verify(half, scene);
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  scene.model.symmetry = scene::Symmetry::none;
  const Solution whole = equilibrium::solve(scene);
  BOOST_TEST(whole.R_tot == half.R_tot, boost::test_tools::tolerance(1e-9));
  // Nothing but the two sliders pushes along e_z.
  const double left = -whole.arcs.front().n(2, 0),
               right = whole.arcs.back().n(2, whole.arcs.back().n.cols() - 1);
  BOOST_TEST(std::abs(left + right) < 1e-9);
  BOOST_TEST(std::abs(right) > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_flat_coil_on_a_plate_slides_between_sliders) {
  for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
    scene::Scene scene = on_sliders(2.0, 2.0 * M_PI, 2.0 * M_PI + 12.0);
    scene.ends.kind = scene::EndKind::clamped;
    scene.ends.travel = travel;
    const double still = between_sliders(scene).R_tot;
    scene.friction = 0.32;
    scene.motion.sliding = scene::Sliding::up;
    scene.plate.emplace().height = 0.3;
    const Solution s = between_sliders(scene, false);
    BOOST_TEST(std::abs(*s.F0 - 0.32 * still) < 1e-10);
    BOOST_TEST(std::abs(s.plate_force - 0.32 * still) < 1e-10);
    const verify::Certificate certificate = verify::verify(s, scene);
    BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  }
}

BOOST_AUTO_TEST_CASE(a_rod_that_has_left_its_plate_slides_between_sliders) {
  scene::Scene scene = on_sliders(0.3, 2.0 * M_PI, 24.0);
  scene.ends.kind = scene::EndKind::clamped;
  scene.ends.travel = scene::Travel::blocked;
  scene.friction = 0.32;
  scene.motion.sliding = scene::Sliding::up;
  scene.plate.emplace();
  scene.model.kind = scene::ModelKind::kirchhoff;
  const Solution s = between_sliders(scene, false);
  BOOST_TEST(s.topology == "tail touch gap touch gap touch:2 tail");
  const verify::Certificate certificate = verify::verify(s, scene);
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  const double sliders = s.arcs.back().n(2, s.arcs.back().n.cols() - 1) - s.arcs.front().n(2, 0);
  BOOST_TEST(std::abs(*s.F0 - s.plate_force + sliders) < 1e-10);
}

BOOST_AUTO_TEST_CASE(thick_coils_between_sliders_are_certified_still_and_sliding) {
  scene::Scene scene = on_sliders(2.0, 2.0 * M_PI, 30.0);
  scene.rod_radius = 2.0 / 7.0;
  scene.self_contact = true;
  scene.model.tolerance = 1e-10;
  const Solution still = equilibrium::solve(scene);
  const verify::Certificate at_rest = verify::verify(still, scene);
  BOOST_TEST(at_rest.passed(), verify::to_text(at_rest));
  BOOST_TEST(still.self_force > 0.1);
  scene.friction = 0.32;
  scene.motion = {scene::Sliding::up, false};
  scene.plate.emplace();
  scene.ends.travel = scene::Travel::blocked;
  const Solution s = equilibrium::solve(scene);
  const verify::Certificate certificate = verify::verify(s, scene);
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  // One tail passes below the other, and its slider holds it at the plate's height: what the cylinder drags with the plate and the
  // sliders carry.
  const double sliders = s.arcs.back().n(2, s.arcs.back().n.cols() - 1) - s.arcs.front().n(2, 0);
  BOOST_TEST(std::abs(*s.F0 - s.plate_force + sliders) < 1e-10);
  BOOST_TEST(std::abs(sliders) > 0.01);
}

BOOST_AUTO_TEST_SUITE_END()
