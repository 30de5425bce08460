#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

Options options_to(double target) {
  Options options;
  options.target = target;
  options.direction = 1;
  return options;
}

BOOST_AUTO_TEST_SUITE(walker)

BOOST_AUTO_TEST_CASE(regular_branch_ends_exactly_at_the_target) {
  auto problem = scalar([](double x, const Vector& p) { return x - std::sin(p[0]); });
  Walker walker(problem, vector({0.3}), vector({0.0}), options_to(2.0));
  const auto points = walk(walker);
  BOOST_TEST((points.front().type == PointType::start));
  BOOST_TEST((points.back().type == PointType::end));
  BOOST_TEST(points.back().p[0] == 2.0);
  BOOST_TEST((walker.end().kind == End::Kind::target));
  for (const Point& point : points) BOOST_TEST(std::abs(point.x[0] - std::sin(point.p[0])) < 1e-10);
  for (std::size_t i = 1; i < points.size(); ++i)
    BOOST_TEST(points[i].path_length > points[i - 1].path_length);
}

BOOST_AUTO_TEST_CASE(path_length_is_the_arc_length_to_second_order) {
  // On the circle the chord-like steps underestimate the arc by O(ds²).
  double error[2];
  int k = 0;
  for (const double step : {0.1, 0.05}) {
    auto problem = scalar([](double x, const Vector& p) { return x * x + p[0] * p[0] - 1.0; });
    Options options = options_to(0.8);
    options.step = options.step_max = step;
    Walker walker(problem, vector({1.0}), vector({0.0}), options);
    error[k++] = std::abs(walk(walker).back().path_length - std::asin(0.8));
  }
  BOOST_TEST(error[0] < 3e-3);
  BOOST_TEST(std::log2(error[0] / error[1]) > 1.7);
}

BOOST_AUTO_TEST_CASE(fold_is_located) {
  auto problem = scalar([](double x, const Vector& p) { return p[0] - 1.0 + (x - 0.3) * (x - 0.3); });
  Options options;
  options.lower = -1.0;
  Walker walker(problem, vector({0.3 - std::sqrt(1.5)}), vector({-0.5}), options);
  const auto points = walk(walker);
  const auto folds = of_type(points, PointType::fold);
  BOOST_REQUIRE_EQUAL(folds.size(), 1u);
  BOOST_TEST(std::abs(folds[0].p[0] - 1.0) < 1e-12);
  BOOST_TEST(std::abs(folds[0].x[0] - 0.3) < 1e-9);
  BOOST_TEST(folds[0].precision < 1e-10);
  BOOST_TEST(std::abs(folds[0].index - folds[0].index_after) == 1);
  BOOST_TEST(of_type(points, PointType::branch_point).empty());
  BOOST_TEST(points.back().p[0] == -1.0);
  BOOST_TEST(std::abs(points.back().x[0] - 0.3 - std::sqrt(2.0)) < 1e-10);
}

BOOST_AUTO_TEST_CASE(target_beyond_a_fold_is_not_overshot) {
  // p rises to 1 at the fold; the target 0.999 is met on the way up, within the step that holds the fold.
  auto problem = scalar([](double x, const Vector& p) { return p[0] - 1.0 + x * x; });
  Options options = options_to(0.999);
  options.step = options.step_max = 0.4;
  Walker walker(problem, vector({-0.4}), vector({0.84}), options);
  const auto points = walk(walker);
  BOOST_TEST(points.back().p[0] == 0.999);
  BOOST_TEST(std::abs(points.back().x[0] + std::sqrt(0.001)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(closed_curve_is_recognised) {
  // Isola x² + (p - 2)² = ¼: two folds, then back at the start.
  auto problem = scalar([](double x, const Vector& p) { return x * x + (p[0] - 2.0) * (p[0] - 2.0) - 0.25; });
  Options options;
  Walker walker(problem, vector({0.5}), vector({2.0}), options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::closed));
  const auto folds = of_type(points, PointType::fold);
  BOOST_REQUIRE_EQUAL(folds.size(), 2u);
  BOOST_TEST(std::abs(folds[0].p[0] - 2.5) < 1e-11);
  BOOST_TEST(std::abs(folds[1].p[0] - 1.5) < 1e-11);
  BOOST_TEST(std::abs(points.back().x[0] - 0.5) < 1e-9);
  BOOST_TEST(of_type(points, PointType::branch_point).empty());
}

BOOST_AUTO_TEST_CASE(closed_curve_started_at_a_fold) {
  auto problem = scalar([](double x, const Vector& p) { return x * x + p[0] * p[0] - 1.0; });
  Walker walker(problem, vector({0.0}), vector({1.0}), Tangent{vector({1.0}), 0.0}, Options{});
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::closed));
  BOOST_TEST(points.back().path_length > 6.0);
  BOOST_TEST(points.back().path_length < 6.8);
}

BOOST_AUTO_TEST_CASE(bratu_fold) {
  // u'' + λ eᵘ = 0, u(0) = u(1) = 0, second-order differences: λ_fold → 3.513830719 as h².
  double fold[2];
  int k = 0;
  for (const int n : {31, 63}) {
    const double h = 1.0 / (n + 1);
    auto residual = [n, h](const Vector& u, const Vector& p) {
      Vector f(n);
      for (int i = 0; i < n; ++i) {
        const double left = i > 0 ? u[i - 1] : 0.0, right = i + 1 < n ? u[i + 1] : 0.0;
        f[i] = (2.0 * u[i] - left - right) / (h * h) - p[0] * std::exp(u[i]);
      }
      return f;
    };
    auto jacobian = [n, h](const Vector& u, const Vector& p) {
      Matrix j = Matrix::Zero(n, n);
      for (int i = 0; i < n; ++i) {
        j(i, i) = 2.0 / (h * h) - p[0] * std::exp(u[i]);
        if (i > 0) j(i, i - 1) = -1.0 / (h * h);
        if (i + 1 < n) j(i, i + 1) = -1.0 / (h * h);
      }
      return j;
    };
    auto problem = std::make_shared<AlgebraicProblem>(n, residual, jacobian);
    Options options;
    options.lower = -0.1;
    options.upper = 5.0;
    options.max_points = 300;
    options.step_max = 1.0;
    Walker walker(problem, Vector::Zero(n), vector({0.0}), options);
    std::vector<Point> points;
    while (auto point = walker.step()) {
      points.push_back(*point);
      if (points.back().p[0] < 2.0 && points.size() > 20) walker.stop("enough");
    }
    const auto folds = of_type(points, PointType::fold);
    BOOST_REQUIRE_EQUAL(folds.size(), 1u);
    BOOST_TEST(of_type(points, PointType::branch_point).empty());
    BOOST_TEST(points.front().index == 0);
    BOOST_TEST(points.back().index == 1);
    fold[k++] = folds[0].p[0];
  }
  const double exact = 3.513830719;
  BOOST_TEST(std::abs(fold[1] - exact) < 1e-3);
  const double order = std::log2((fold[0] - exact) / (fold[1] - exact));
  BOOST_TEST(std::abs(order - 2.0) < 0.02);
}

BOOST_AUTO_TEST_CASE(manifold_state) {
  // x on the unit circle in R², one degree of freedom (the angle): equilibrium of a pendulum at angle p.
  class Circle : public AlgebraicProblem {
   public:
    Circle()
        : AlgebraicProblem(1, [](const Vector& x, const Vector& p) {
            return vector({x[1] * std::cos(p[0]) - x[0] * std::sin(p[0])});
          }) {}
    Vector retract(const Vector& x, const Vector& dx) const override {
      const double c = std::cos(dx[0]), s = std::sin(dx[0]);
      return vector({c * x[0] - s * x[1], s * x[0] + c * x[1]});
    }
    std::shared_ptr<Problem> clone() const override { return std::make_shared<Circle>(*this); }
  };
  Options options = options_to(7.0);
  options.detect_closed = false;
  Walker walker(std::make_shared<Circle>(), vector({1.0, 0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  BOOST_TEST(points.back().p[0] == 7.0);
  for (const Point& point : points) {
    BOOST_TEST(std::abs(point.x.norm() - 1.0) < 1e-13);
    BOOST_TEST(std::abs(point.x[0] - std::cos(point.p[0])) < 1e-10);
  }
  // In the metric dθ² + dp² the branch θ = p has length √2 · 7, and straight branches are measured exactly.
  BOOST_TEST(std::abs(points.back().path_length - 7.0 * std::sqrt(2.0)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(at_most_three_factorisations_a_point) {
  auto problem = scalar([](double x, const Vector& p) { return x * x * x + x - 5.0 * std::sin(p[0]); });
  Walker walker(problem, vector({0.0}), vector({0.0}), options_to(1.5));
  const auto points = walk(walker);
  BOOST_TEST(points.size() > 5u);
  BOOST_TEST(problem->factorizations <= 3 * static_cast<int>(points.size()) + 3);
}

BOOST_AUTO_TEST_CASE(lost_branch_says_why) {
  // The domain ends at p = 1 although the branch does not.
  auto problem = scalar([](double x, const Vector& p) {
    if (p[0] > 1.0) throw std::domain_error("p > 1");
    return x - p[0];
  });
  Walker walker(problem, vector({0.0}), vector({0.0}), options_to(2.0));
  const auto points = walk(walker);
  BOOST_TEST(walker.end().lost());
  BOOST_TEST(walker.end().reason.find("Newton failed at step_min") != std::string::npos);
  BOOST_TEST(walker.end().reason.find("p > 1") != std::string::npos);
  BOOST_TEST(points.back().p[0] > 0.999999);
  BOOST_TEST(points.back().p[0] <= 1.0);
}

BOOST_AUTO_TEST_CASE(not_a_number_is_a_failure) {
  auto problem = scalar([](double x, const Vector& p) { return x - std::sqrt(1.0 - p[0]); });
  Walker walker(problem, vector({1.0}), vector({0.0}), options_to(2.0));
  const auto points = walk(walker);
  BOOST_TEST(walker.end().lost());
  for (const Point& point : points) BOOST_TEST(std::isfinite(point.x[0]));
}

BOOST_AUTO_TEST_CASE(no_solution_at_the_start) {
  auto problem = scalar([](double x, const Vector& p) { return x * x + 1.0 + p[0]; });
  Walker walker(problem, vector({1.0}), vector({0.0}), options_to(2.0));
  BOOST_TEST(walk(walker).empty());
  BOOST_TEST(walker.end().lost());
  BOOST_TEST(walker.end().reason.find("no solution at the start") == 0u);
}

BOOST_AUTO_TEST_CASE(restart_from_a_stored_point_follows_the_same_branch) {
  const auto make = [] { return scalar([](double x, const Vector& p) { return p[0] - x + x * x * x; }); };
  Options options;
  options.upper = 2.0;
  options.lower = -2.0;
  Walker first(make(), vector({-1.6}), vector({-1.6 + 1.6 * 1.6 * 1.6}), options);
  // Starts above: walk down instead.
  options.direction = -1;
  Walker walker(make(), vector({-1.2}), vector({-1.2 + 1.2 * 1.2 * 1.2}), options);
  const auto points = walk(walker);
  const auto folds = of_type(points, PointType::fold);
  BOOST_REQUIRE_EQUAL(folds.size(), 2u);
  const double at = 2.0 / (3.0 * std::sqrt(3.0));
  BOOST_TEST(std::abs(std::abs(folds[0].p[0]) - at) < 1e-11);
  // Restart from the first fold itself, forwards along the stored tangent.
  Walker again(folds[0].problem, folds[0].x, folds[0].p, folds[0].tangent, options);
  const auto rest = walk(again);
  const auto more = of_type(rest, PointType::fold);
  BOOST_REQUIRE_EQUAL(more.size(), 1u);
  BOOST_TEST(std::abs(more[0].p[0] - folds[1].p[0]) < 1e-11);
  BOOST_TEST(rest.back().p[0] == points.back().p[0]);
  BOOST_TEST(std::abs(rest.back().x[0] - points.back().x[0]) < 1e-9);
}

BOOST_AUTO_TEST_CASE(max_points_and_stop) {
  auto problem = scalar([](double x, const Vector& p) { return x - p[0]; });
  Options options;
  options.max_points = 7;
  Walker walker(problem, vector({0.0}), vector({0.0}), options);
  BOOST_TEST(walk(walker).size() == 7u);
  BOOST_TEST((walker.end().kind == End::Kind::max_points));
  Walker stopped(problem, vector({0.0}), vector({0.0}), options);
  stopped.step();
  stopped.stop("Ctrl-C");
  BOOST_TEST(!stopped.step());
  BOOST_TEST(stopped.end().reason == "Ctrl-C");
}

BOOST_AUTO_TEST_CASE(adaptation_changes_the_size) {
  // n copies of x = p² - p averaged; adapt alternates between n = 1, 2, 3.
  auto problem = std::make_shared<AlgebraicProblem>(1, AlgebraicProblem::Residual{});
  *problem = AlgebraicProblem(
      1, [](const Vector& x, const Vector& p) { return Vector((x.array().cube() - p[0] + 1.0).matrix()); });
  int calls = 0;
  problem->adapt_of = [&calls](AlgebraicProblem& self, const Vector& x,
                               const Vector&) -> std::optional<Vector> {
    ++calls;
    const Eigen::Index n = 1 + calls % 3;
    self.set_size(n);
    return Vector::Constant(n, x[0]);
  };
  Walker walker(problem, vector({1.0}), vector({2.0}), options_to(9.0));
  const auto points = walk(walker);
  BOOST_TEST(calls > 3);
  BOOST_TEST(points.back().p[0] == 9.0);
  bool changed = false;
  for (const Point& point : points) {
    changed = changed || point.x.size() == 3;
    for (const double x : point.x) BOOST_TEST(std::abs(x - std::cbrt(point.p[0] - 1.0)) < 1e-9);
    BOOST_TEST(point.x.size() == point.tangent.x.size());
  }
  BOOST_TEST(changed);
}

BOOST_AUTO_TEST_CASE(points_are_adapted_before_they_are_yielded) {
  auto problem = std::make_shared<AlgebraicProblem>(
      1, [](const Vector& x, const Vector& p) { return Vector((x.array().cube() - p[0] + 1.0).matrix()); });
  double adapted_at = 2.0;
  problem->adapt_of = [&adapted_at](AlgebraicProblem& self, const Vector& x,
                                    const Vector& p) -> std::optional<Vector> {
    adapted_at = p[0];
    self.set_size(p[0] < 5.0 ? 2 : 3);
    return Vector::Constant(self.size(), x[0]);
  };
  Walker walker(problem, vector({1.0}), vector({2.0}), options_to(9.0));
  BOOST_TEST(walker.step()->x.size() == 1);  // the start is the caller's
  while (const auto point = walker.step()) {
    BOOST_TEST(std::abs(point->p[0] - adapted_at) < 1e-9);  // corrected once more on the new discretisation
    BOOST_TEST(point->x.size() == (point->p[0] < 5.0 ? 2 : 3));
    BOOST_TEST(point->problem->size() == point->x.size());
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
