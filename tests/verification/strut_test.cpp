// Clamped struts and rings against what is known exactly: Euler's load and the elastica beyond it, Greenhill's twisted
// strut, Michell's ring.
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/branch_switch.hpp>
#include <continuation/walker.hpp>

#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"

namespace {

using namespace windlass;
using continuation::Point;
using continuation::PointType;
using equilibrium::Started;

constexpr double ratio = 2.0 / 3.0;  // GJ/EI

scene::Scene strut(double twist = 0.0) {
  scene::Scene scene;
  scene.name = "strut";
  scene.rod.length = 1.0;
  scene.ends.kind = scene::EndKind::clamped;
  scene.ends.twist = twist;
  scene.model.tolerance = 1e-10;
  return scene;
}

scene::Scene under_thrust(double thrust, double twist = 0.0) {
  scene::Scene scene = strut(twist);
  scene.load.thrust = thrust;
  return scene;
}

scene::Scene shortened(double shortening, double twist = 0.0) {
  scene::Scene scene = strut(twist);
  scene.ends.shortening = shortening;
  return scene;
}

template <class F>
double root(F&& f, double low, double high) {
  std::uintmax_t most = 200;
  const auto bracket =
      boost::math::tools::toms748_solve(f, low, high, boost::math::tools::eps_tolerance<double>(52), most);
  return 0.5 * (bracket.first + bracket.second);
}

/// The branch points met from the scene's state to `target` in `key`.
std::vector<Point> branch_points(const scene::Scene& scene, const std::string& key, double target,
                                 bool half = true) {
  Started start = equilibrium::cold_start(scene, true, half, {key});
  continuation::Options options;
  options.target = target;
  options.direction = target > start.p(0) ? 1 : -1;
  options.parameter_scale = 0.2 * std::abs(target - start.p(0));
  continuation::Walker walker(start.problem, start.x, start.p, options);
  std::vector<Point> found;
  while (const auto point = walker.step())
    if (point->type == PointType::branch_point) found.push_back(*point);
  BOOST_TEST(!walker.end().lost(), walker.end().reason);
  return found;
}

int total_index(const scene::Scene& scene, bool half) {
  Started start = equilibrium::cold_start(scene, true, half, {equilibrium::load_key(scene)});
  return start.problem->total_index(start.x, start.p);
}

/// The first mode of a clamped elastica is four quarters of an inflexional one: with k = sin(α/2), α the largest angle,
///     P = (4 K(k)/L)²,   shortening = 2 − 2 E(k)/K(k),
/// since each quarter is K/√P long and spans (2E − K)/√P; and ½θ'² = P (cos θ − cos α) integrates to the energy
///     P L ((1 − shortening) − (1 − 2k²)).
struct Elastica {
  double k, thrust, energy;
  explicit Elastica(double shortening) {
    using boost::math::ellint_1, boost::math::ellint_2;
    k = root([&](double m) { return 2.0 - 2.0 * ellint_2(m) / ellint_1(m) - shortening; }, 1e-6, 0.999999);
    thrust = 16.0 * ellint_1(k) * ellint_1(k);
    energy = thrust * (2.0 * k * k - shortening);
  }
};

/// Greenhill's condition for clamped ends (A. G. Greenhill, Proc. Inst. Mech. Eng. 1883, for hinged ones).
///
/// Small deflections w = y + iz of a straight rod under the thrust P and the axial moment M obey
/// w'''' − iM w''' + P w'' = 0 (EI = 1), so w = a + bs + c₁ exp(iα₁s) + c₂ exp(iα₂s) with α² − Mα − P = 0. Of the four
/// conditions w = w' = 0 at s = ±h, h = L/2, sums and differences leave, with A = α₁h and B = α₂h,
///     c₁ A sin A + c₂ B sin B = 0,   c₁ (sin A − A cos A) + c₂ (sin B − B cos B) = 0,
/// whose determinant is  A sin A (sin B − B cos B) − B sin B (sin A − A cos A).  At M = 0 it is proportional to
/// sin A (sin A − A cos A): P = 4π²/L² and tan A = A. The problem is invariant under w → exp(iγ) w: each root has two modes.
double greenhill(double thrust, double moment) {
  const double nu = std::sqrt(0.25 * moment * moment + thrust);
  const double a = 0.5 * (0.5 * moment + nu), b = 0.5 * (0.5 * moment - nu);  // h = 1/2
  return a * std::sin(a) * (std::sin(b) - b * std::cos(b)) -
         b * std::sin(b) * (std::sin(a) - a * std::cos(a));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(struts)

BOOST_AUTO_TEST_CASE(buckled_strut_is_the_elastica_in_elliptic_integrals) {
  for (const double shortening : {1e-4, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9}) {
    Started start = equilibrium::cold_start(shortened(shortening), true, true, {"ends.shortening"});
    const equilibrium::Solution s = equilibrium::record(*start.problem, start.x, start.p);
    const Elastica exact(shortening);
    BOOST_TEST_CONTEXT("shortening " << shortening) {
      // Ten times the tolerance asked for; the energy is a sum over the rod and errs as the force does.
      BOOST_TEST(std::abs(s.end_force / exact.thrust - 1.0) < 1e-9);
      BOOST_TEST(std::abs(s.energy / exact.energy - 1.0) < 1e-9);
      BOOST_TEST(s.shortening == shortening, boost::test_tools::tolerance(1e-8));  // 1 − x/L cancels at 1e-4
    }
  }
}

BOOST_AUTO_TEST_CASE(straight_strut_buckles_at_eulers_loads_in_both_planes) {
  const auto found = branch_points(under_thrust(10.0), "load.thrust", 100.0);
  BOOST_TEST_REQUIRE(found.size() == 2u);
  // cos: sin(√P/2) = 0; then tan(√P/2) = √P/2, whose least root is 4.4934.
  const double second = root([](double a) { return std::sin(a) - a * std::cos(a); }, 4.0, 4.6);
  // At the first load half the strut, its ends held, is singular by itself: elimination without pivoting then leaves 2e-8.
  BOOST_TEST(found[0].p(0) == 4.0 * M_PI * M_PI, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found[1].p(0) == 4.0 * second * second, boost::test_tools::tolerance(1e-9));
  // Each load has a mode in every plane through the axis: the index rises by two. The half chain sees both.
  BOOST_TEST(total_index(under_thrust(39.0), true) == 0);
  BOOST_TEST(total_index(under_thrust(40.0), true) == 2);
  BOOST_TEST(total_index(under_thrust(81.0), true) == 4);
}

BOOST_AUTO_TEST_CASE(one_arm_stands_for_all_planes_of_buckling) {
  const auto found = branch_points(under_thrust(30.0), "load.thrust", 50.0);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  continuation::Options options;
  options.parameter_scale = 5.0;
  const continuation::Arms arms = continuation::switch_branch(found[0], options);
  BOOST_TEST(arms.failures.empty());
  BOOST_TEST_REQUIRE(arms.arms.size() ==
                     1u);  // up and down are mirror images; other planes are turned by symmetry
  BOOST_TEST(arms.arms[0].count == 2);
  options.target = 60.0;
  options.direction = 1;
  const auto& arm = arms.arms[0];
  continuation::Walker walker(arm.problem, arm.x, arm.p, arm.tangent, options);
  while (walker.step()) {
  }
  BOOST_TEST_REQUIRE((walker.end().kind == continuation::End::Kind::target), walker.end().reason);
  auto& problem = dynamic_cast<equilibrium::RodProblem&>(*walker.problem());
  const equilibrium::Solution s = equilibrium::record(problem, walker.x(), walker.p());
  const double shortening = root([](double d) { return Elastica(d).thrust - 60.0; }, 0.5, 0.8);
  BOOST_TEST(s.shortening == shortening, boost::test_tools::tolerance(1e-9));
  // Turning about the axis is a rigid motion and does not count: under a dead thrust above Euler's the elastica is stable
  // in its plane, and leaves it only at larger shortening.
  BOOST_TEST(problem.total_index(arm.x, arm.p) == 0);
}

BOOST_AUTO_TEST_CASE(twisted_strut_buckles_at_greenhills_load) {
  for (const double twist : {0.5 * M_PI, 2.0 * M_PI, 4.0 * M_PI}) {
    const double moment = ratio * twist;
    const double exact = root([&](double p) { return greenhill(p, moment); }, 1.0, 39.45);
    const auto found = branch_points(under_thrust(2.0, twist), "load.thrust", 42.0);
    BOOST_TEST_CONTEXT("twist " << twist << ", exact " << exact) {
      BOOST_TEST_REQUIRE(found.size() == 1u);
      BOOST_TEST(found[0].p(0) == exact, boost::test_tools::tolerance(1e-9));
      BOOST_TEST(total_index(under_thrust(1.001 * exact, twist), true) == 2);
    }
  }
}

BOOST_AUTO_TEST_CASE(michells_ring_loses_stability_at_its_twist) {
  // A strut whose ends meet (shortening 1) after a full turn of twist is an untwisted ring: closing a straight rod takes
  // 2π of link. Beyond, the ring's own twist Φ makes its moment GJ Φ/L; it buckles at Φ = 2π√3 EI/GJ (J. H. Michell,
  // Messenger of Math. 1890). The clamped point holds the rigid motions of the free ring and nothing else.
  const scene::Scene ring = shortened(1.0, 2.0 * M_PI);
  Started start = equilibrium::cold_start(ring, true, true, {"ends.twist"});
  const equilibrium::Solution s = equilibrium::record(*start.problem, start.x, start.p);
  BOOST_TEST(s.energy == 0.5 * 4.0 * M_PI * M_PI, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(start.problem->total_index(start.x, start.p) == 0);
  const double critical = 2.0 * M_PI * (1.0 + std::sqrt(3.0) / ratio);
  const auto found = branch_points(ring, "ends.twist", 1.1 * critical);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(found[0].p(0) == critical, boost::test_tools::tolerance(1e-8));
}

BOOST_AUTO_TEST_CASE(half_and_full_chains_of_struts_agree) {
  for (const double twist : {0.0, M_PI}) {
    const scene::Scene scene = shortened(0.3, twist);
    Started half = equilibrium::cold_start(scene, true, true, {"ends.shortening"});
    Started full = equilibrium::cold_start(scene, true, false, {"ends.shortening"});
    const auto a = equilibrium::record(*half.problem, half.x, half.p),
               b = equilibrium::record(*full.problem, full.x, full.p);
    BOOST_TEST(a.end_force == b.end_force, boost::test_tools::tolerance(1e-10));
    BOOST_TEST(half.problem->total_index(half.x, half.p) == full.problem->total_index(full.x, full.p));
  }
}

BOOST_AUTO_TEST_CASE(no_shortening_is_the_straight_strut_and_says_what_it_carries) {
  const equilibrium::Solution s = equilibrium::solve(shortened(0.0));
  BOOST_TEST(s.end_force == 0.0);
  BOOST_TEST(std::abs(s.energy) < 1e-20);
  BOOST_TEST(s.model_reason.find("39.4784176") != std::string::npos, s.model_reason);
  // Beyond the buckling load, solve answers with the buckled state.
  const equilibrium::Solution buckled = equilibrium::solve(under_thrust(45.0));
  BOOST_TEST(buckled.shortening == root([](double d) { return Elastica(d).thrust - 45.0; }, 0.05, 0.5),
             boost::test_tools::tolerance(1e-8));
}

BOOST_AUTO_TEST_SUITE_END()
