// Branches that come close to each other: no step goes from one to another, and nothing is reported between them.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/diagram.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

std::shared_ptr<DenseProblem> one_equation(std::function<double(double, double)> f) {
  return std::make_shared<DenseProblem>(
      1, [f = std::move(f)](const Vector& x, const Vector& p) { return vector({f(x[0], p[0])}); });
}

BOOST_AUTO_TEST_SUITE(jumps)

BOOST_AUTO_TEST_CASE(perturbed_pitchfork_stays_on_its_part) {
  // The gap is e^(1/3) wide in x; the part that is stable at p < 0 stays stable and ends at x > 1.
  for (const double e : {1e-3, 1e-4, 1e-6}) {
    for (const double step_max : {0.1, 0.2, 0.3, 0.4, 0.5}) {
      const auto problem = one_equation([e](double x, double p) { return -(p * x - x * x * x + e); });
      Options options;
      options.lower = -1.0;
      options.upper = 1.0;
      options.step_max = step_max;
      Walker walker(problem, vector({e}), vector({-1.0}), options);
      const auto points = walk(walker);
      BOOST_TEST_CONTEXT("e " << e << ", step_max " << step_max) {
        BOOST_TEST(of_type(points, PointType::branch_point).empty());
        BOOST_TEST(of_type(points, PointType::fold).empty());
        BOOST_TEST((walker.end().kind == End::Kind::bound));
        BOOST_TEST(points.back().x[0] > 1.0);
        for (const Point& point : points) BOOST_TEST(point.index == 0);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(parallel_branches_are_kept_apart) {
  // x = sin p + k/10 for every integer k; neighbours differ in index, every second one does not.
  for (const bool index_known : {true, false}) {
    for (const double step_max : {0.1, 0.3, 0.5}) {
      auto problem = scalar(
          [](double x, const Vector& p) { return std::sin(10.0 * M_PI * (x - std::sin(p[0]))) / 10.0; });
      problem->index_known = index_known;
      Options options;
      options.lower = 0.0;
      options.upper = 6.0;
      options.step_max = step_max;
      Walker walker(problem, vector({0.0}), vector({0.0}), options);
      const auto points = walk(walker);
      BOOST_TEST_CONTEXT("index known " << index_known << ", step_max " << step_max) {
        BOOST_TEST(of_type(points, PointType::branch_point).empty());
        BOOST_TEST(of_type(points, PointType::fold).empty());
        BOOST_TEST(points.back().p[0] == 6.0);
        // Half the distance of two branches would do to tell them apart.
        for (const Point& point : points) BOOST_TEST(std::abs(point.x[0] - std::sin(point.p[0])) < 1e-8);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
