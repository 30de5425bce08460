// Balance of a dragged rod: derivatives with everything at work, rigid motions, and the law of friction.
#include "windlass/pull/dragged_rod.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/pull/friction.hpp"

using namespace windlass;
using discrete_rod::OpenSpline;
using discrete_rod::SplineRod;
using Eigen::VectorXd;
using pull::Coulomb;
using pull::DraggedRod;
using pull::Memory;
using pull::Setting;
using pull::Step;

namespace {

constexpr double h = 0.35;

DraggedRod rod_of(bool blocked) {
  Setting setting{.tension = 0.8,
                  .angle = 2.0 * M_PI,
                  .plate = 0.3,
                  .below = -0.35,
                  .compliance = blocked ? 0.02 : 0.0,
                  .blocked = blocked,
                  .coulomb = {0.4, 0.03}};
  return {OpenSpline(SplineRod(6.0, 6.0, h)), setting, h};
}

/// A bumpy coil pressed into the cylinder, part of it above the plate, its lengths a little off.
VectorXd coil(const DraggedRod& rod, double phase) {
  std::vector<OpenSpline::Point> points;
  for (int j = 0; j <= rod.spline().elements(); ++j) {
    const double s = rod.spline().knot(j);
    points.emplace_back(0.97 * std::sin(s), -0.97 * std::cos(s), 0.1 * s + 0.01 * std::sin(3.0 * s + phase));
  }
  VectorXd u = rod.unknowns(rod.spline().through(points));
  for (Eigen::Index k = 0; k < u.size(); ++k) u(k) += 0.004 * std::sin(7.0 * static_cast<double>(k) + phase);
  return u;
}

/// The last step's end: slips inside the cone, at its corner and beyond, in all directions.
Memory before(const DraggedRod& rod) {
  Memory last = rod.fresh_memory(coil(rod, 0.4));
  for (Eigen::Index k = 0; k < last.slip.cols(); ++k)
    last.slip.col(k) = 0.02 * Eigen::Vector2d(std::cos(1.7 * static_cast<double>(k)),
                                              std::sin(2.9 * static_cast<double>(k)));
  return last;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(dragged_rods)

BOOST_AUTO_TEST_CASE(the_matrix_is_the_derivative_of_the_balance) {
  for (const bool blocked : {false, true}) {
    const DraggedRod rod = rod_of(blocked);
    const Memory last = before(rod);
    const Step step{0.03, 0.7, true};
    VectorXd u = coil(rod, 0.0);
    if (blocked) u(u.size() - 1) = 0.11;
    const pull::Measured at = rod.measured(u, last, step);
    BOOST_REQUIRE(at.R_tot > 1.0);
    BOOST_REQUIRE(at.plate_force > 0.1);
    BOOST_REQUIRE(at.sticking > 0.1);
    BOOST_REQUIRE(at.sticking < 0.9);
    VectorXd residual, up, down;
    DraggedRod::Sparse matrix;
    rod.evaluate(u, last, step, residual, &matrix);
    const Eigen::MatrixXd dense = matrix;
    BOOST_TEST((dense - dense.transpose()).lpNorm<Eigen::Infinity>() > 1e-2);  // friction has no potential
    constexpr double small = 1e-6;
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      VectorXd ahead = u, behind = u;
      ahead(k) += small, behind(k) -= small;
      rod.evaluate(ahead, last, step, up, nullptr);
      rod.evaluate(behind, last, step, down, nullptr);
      const VectorXd column = (up - down) / (2.0 * small);
      // Where a place passes from one piece of a rounded kink to the next its second derivative jumps: by bed over
      // rounding, 3e4 here, a hundredth of which counts, times the step.
      BOOST_TEST((column - dense.col(k)).lpNorm<Eigen::Infinity>() < 3e-4);
    }
  }
}

BOOST_AUTO_TEST_CASE(rigid_motions_find_the_resultants) {
  // Tested with a translation along the axis the residual is plate force less drag; the pulls have no such part.
  DraggedRod rod = rod_of(false);
  rod.setting.below = -HUGE_VAL;  // its force would count the other way
  const Memory last = before(rod);
  const Step step{0.03, 0.0, true};
  const VectorXd u = coil(rod, 0.0);
  const pull::Measured at = rod.measured(u, last, step);
  VectorXd residual;
  rod.evaluate(u, last, step, residual, nullptr);
  double along = 0.0;
  for (Eigen::Index k = 2; k < rod.spline().size(); k += 3) along += residual(k);
  BOOST_TEST(std::abs(along - (at.plate_force - at.drag)) < 1e-12);
  // Without friction and plate a turn about the axis finds the torque of the pulls alone: contact is normal.
  rod.evaluate(u, last, {0.0, 0.0, false, false}, residual, nullptr);
  double torque = 0.0;
  for (Eigen::Index k = 0; k < rod.spline().size(); k += 3)
    torque += u(k) * residual(k + 1) - u(k + 1) * residual(k);
  const OpenSpline::Point a = OpenSpline::position(u, 0, 0.0),
                          b = OpenSpline::position(u, rod.spline().elements() - 1, 1.0);
  const double half = 0.5 * rod.setting.angle, T = rod.setting.tension;
  const double pulls =
      T * (a(0) * std::sin(half) + a(1) * std::cos(half) + b(0) * std::sin(half) - b(1) * std::cos(half));
  // What straightens the ends is no rigid motion's business either.
  BOOST_TEST(std::abs(torque + pulls) < 1e-10);
}

BOOST_AUTO_TEST_CASE(friction_keeps_to_its_cone_and_opposes_the_slip) {
  const Coulomb coulomb{0.3, 1e-3};
  for (double size = 1e-5; size < 1.0; size *= 1.3) {
    const Eigen::Vector2d g = size * Eigen::Vector2d(0.6, -0.8);
    const Coulomb::Traction q = coulomb(g);
    BOOST_TEST(q.by_pressure.norm() <= 0.3 * (1.0 + 1e-15));
    BOOST_TEST(q.by_pressure.dot(g) == -q.by_pressure.norm() * size, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(q.sticks == (q.by_pressure.norm() < 0.3 * (1.0 - 1e-15)));
    // What is remembered gives the same traction.
    BOOST_TEST((coulomb(coulomb.kept(g)).by_pressure - q.by_pressure).norm() < 1e-15);
  }
  BOOST_TEST(coulomb(Eigen::Vector2d::Zero()).by_pressure.norm() == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
