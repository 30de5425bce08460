// Arms of branch points that are walked once: a branch through itself, a double point with the symmetry of the square.
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

BOOST_AUTO_TEST_SUITE(arms)

// Counts what a diagram hands out.
struct Count : DiagramObserver {
  int branch_points = 0;
  void on_special_point(const Branch&, const Point& point) override {
    branch_points += point.type == PointType::branch_point;
  }
};

BOOST_AUTO_TEST_CASE(a_branch_through_itself_has_one_branch_point_and_no_arms) {
  // Lemniscate (x² + p²)² = p² − x²: one closed branch through (0, 0).
  const auto problem = one_equation([](double x, double p) {
    const double r = x * x + p * p;
    return r * r - p * p + x * x;
  });
  Options options;
  options.step = 0.05;
  options.step_max = 0.1;
  Count count;
  const double p = 0.5, r2 = 0.5 * (-1.0 - 2.0 * p * p + std::sqrt(1.0 + 8.0 * p * p));
  const Diagram diagram = trace_diagram(problem, vector({std::sqrt(r2)}), vector({p}), options, {}, count);
  BOOST_TEST(count.branch_points == 1);
  BOOST_REQUIRE_EQUAL(diagram.branches.size(), 1u);
  BOOST_TEST((diagram.branches[0].end.kind == End::Kind::closed));
  BOOST_TEST(diagram.lost.empty());
  int folds = 0;
  for (const SpecialPoint& special : diagram.specials) {
    if (special.point.type != PointType::fold) continue;
    ++folds;
    BOOST_TEST(std::abs(std::abs(special.point.p[0]) - 1.0) < 1e-10);
  }
  BOOST_TEST(folds == 2);
}

BOOST_AUTO_TEST_CASE(arms_of_the_square_are_found_without_its_symmetry) {
  // λ a = a³ + 3 a b², λ b = b³ + 3 b a²: four arms along the axes, four along the diagonals.
  const auto problem = std::make_shared<DenseProblem>(2, [](const Vector& x, const Vector& p) {
    const double a = x[0], b = x[1];
    return vector({-p[0] * a + a * a * a + 3.0 * a * b * b, -p[0] * b + b * b * b + 3.0 * b * a * a});
  });
  Options options;
  options.lower = -2.0;
  options.upper = 1.0;
  options.step = 0.07;
  Walker walker(problem, vector({0.0, 0.0}), vector({-1.0}), options);
  const auto found = of_type(walk(walker), PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  BOOST_TEST(found[0].multiplicity == 2);
  const Arms arms = switch_branch(found[0], options);
  BOOST_TEST(arms.failures.empty());
  BOOST_REQUIRE_EQUAL(arms.arms.size(), 8u);
  int axes = 0, diagonals = 0;
  for (const Arm& arm : arms.arms) {
    const double a = std::abs(arm.x[0]), b = std::abs(arm.x[1]);
    axes += std::min(a, b) < 1e-8 && std::abs(arm.p[0] - std::max(a, b) * std::max(a, b)) < 1e-9;
    diagonals += std::abs(a - b) < 1e-8 && std::abs(arm.p[0] - 4.0 * a * a) < 1e-9;
  }
  BOOST_TEST(axes == 4);
  BOOST_TEST(diagonals == 4);
}

BOOST_AUTO_TEST_CASE(folium_is_walked_once_from_both_ends_of_its_loop) {
  // Descartes: x³ + p³ = 3 x p in u and v, turned so that neither branch is vertical at the double point.
  const auto problem = one_equation([](double x, double p) {
    const double u = (2.0 * p + x) / std::sqrt(5.0), v = (p - 2.0 * x) / std::sqrt(5.0);
    return u * u * u + v * v * v - 3.0 * u * v;
  });
  for (const bool both_ways : {false, true}) {
    Options options;
    options.step_max = 0.1;
    options.lower = -2.0;
    options.upper = 3.0;
    Count count;
    DiagramOptions limits;
    limits.both_ways = both_ways;
    // The loop's tip u = v = 3/2.
    const Diagram diagram = trace_diagram(problem, vector({-1.5 / std::sqrt(5.0)}),
                                          vector({4.5 / std::sqrt(5.0)}), options, limits, count);
    BOOST_TEST(count.branch_points == 1);
    BOOST_TEST(diagram.lost.empty());
    // From the tip through the double point to one bound; the rest of the loop; from the double point to the other bound.
    int ends = 0, joins = 0;
    for (const Branch& branch : diagram.branches) {
      ends += branch.end.kind == End::Kind::bound;
      joins += branch.end.kind == End::Kind::joined;
    }
    BOOST_TEST(ends == 2);
    BOOST_TEST(joins == 1);
    BOOST_TEST(diagram.branches.size() == 3u);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
