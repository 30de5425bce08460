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

BOOST_AUTO_TEST_SUITE(crossings)

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

BOOST_AUTO_TEST_CASE(brusselator_has_a_hopf_point_and_no_branch_point) {
  // A − (B + 1) x + x² y, B x − x² y with A = 1: the pair crosses at B = 2 and turns real at B = 4.
  const auto problem = std::make_shared<DenseProblem>(2, [](const Vector& x, const Vector& p) {
    const double b = p[0], reaction = x[0] * x[0] * x[1];
    return vector({-(1.0 - (b + 1.0) * x[0] + reaction), -(b * x[0] - reaction)});
  });
  Options options;
  options.upper = 6.0;
  Walker walker(problem, vector({1.0, 1.0}), vector({1.0}), options);
  const auto points = walk(walker);
  BOOST_TEST(of_type(points, PointType::branch_point).empty());
  const auto hopf = of_type(points, PointType::hopf);
  BOOST_REQUIRE_EQUAL(hopf.size(), 1u);
  BOOST_TEST(std::abs(hopf[0].p[0] - 2.0) < 1e-9);
  BOOST_TEST(points.back().index == 2);
}

BOOST_AUTO_TEST_CASE(a_pair_that_turns_real_is_no_branch_point_even_if_only_real_ones_are_counted) {
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    const double b = p[0], reaction = x[0] * x[0] * x[1];
    return vector({-(1.0 - (b + 1.0) * x[0] + reaction), -(b * x[0] - reaction)});
  });
  Options options;
  options.upper = 6.0;
  Walker walker(problem, vector({1.0, 1.0}), vector({1.0}), options);
  BOOST_TEST(of_type(walk(walker), PointType::branch_point).empty());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
