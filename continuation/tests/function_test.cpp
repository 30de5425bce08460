// Functions of the caller's along a branch.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

BOOST_AUTO_TEST_SUITE(functions)

BOOST_AUTO_TEST_CASE(user_functions_are_recorded_located_and_may_stop) {
  const auto problem = std::make_shared<DenseProblem>(
      1, [](const Vector& x, const Vector& p) { return vector({x[0] - std::exp(p[0])}); });
  Options options;
  options.upper = 2.0;
  options.functions = {{"x = 2", [](const Vector& x, const Vector&) { return x[0] - 2.0; }, false},
                       {"x = 3", [](const Vector& x, const Vector&) { return x[0] - 3.0; }, true}};
  Walker walker(problem, vector({1.0}), vector({0.0}), options);
  const auto points = walk(walker);
  for (const Point& point : points) BOOST_TEST(point.functions.at(0) == point.x[0] - 2.0);
  const auto zeros = of_type(points, PointType::function);
  BOOST_REQUIRE_EQUAL(zeros.size(), 2u);
  BOOST_TEST(zeros[0].event == "x = 2");
  BOOST_TEST(std::abs(zeros[0].p[0] - std::log(2.0)) < 1e-9);
  BOOST_TEST((walker.end().kind == End::Kind::function));
  BOOST_TEST(std::abs(points.back().p[0] - std::log(3.0)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(precision_of_a_zero_contains_what_newton_leaves) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const auto problem = std::make_shared<DenseProblem>(1, [](const Vector& x, const Vector& p) {
      return vector({x[0] - std::exp(p[0]) + 0.1 * x[0] * x[0]});
    });
    Options options;
    options.upper = 1.0;
    options.newton_tolerance = tolerance;
    options.residual_tolerance = 1.0;
    options.functions = {{"x = 2", [](const Vector& x, const Vector&) { return x[0] - 2.0; }, false}};
    Walker walker(problem, vector({0.9}), vector({0.0}), options);
    const auto zeros = of_type(walk(walker), PointType::function);
    BOOST_REQUIRE_EQUAL(zeros.size(), 1u);
    BOOST_TEST(std::abs(zeros[0].p[0] - std::log(2.4)) <= zeros[0].precision + 1e-15);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
