// Units, loose tolerances, starts on singular points, user functions.
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/diagram.hpp"
#include "continuation/sparse_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

/// ρ (p/π − 1 + (x/σ − 0.3)² + coupling): a fold at p = π in the units σ, π, ρ.
std::shared_ptr<DenseProblem> parabola(double sigma, double pi, double rho) {
  return std::make_shared<DenseProblem>(
      1,
      [=](const Vector& x, const Vector& p) {
        return vector({rho * (p[0] / pi - 1.0 + std::pow(x[0] / sigma - 0.3, 2))});
      },
      [=](const Vector& x, const Vector&) {
        return Matrix::Constant(1, 1, rho * 2.0 * (x[0] / sigma - 0.3) / sigma).eval();
      });
}

Options in_units(double sigma, double pi, double rho) {
  Options options;
  options.state_scale = sigma;
  options.parameter_scale = pi;
  options.residual_scale = rho;
  options.lower = -pi;
  return options;
}

BOOST_AUTO_TEST_SUITE(scales)

BOOST_AUTO_TEST_CASE(a_branch_does_not_depend_on_units) {
  std::size_t points_in_ones = 0;
  for (const auto& [sigma, pi, rho] :
       {std::array{1.0, 1.0, 1.0}, std::array{1e-8, 1.0, 1.0}, std::array{1.0, 1e6, 1.0},
        std::array{1.0, 1.0, 1e8}, std::array{1e-8, 1e6, 1e8}}) {
    Walker walker(parabola(sigma, pi, rho), vector({-0.9 * sigma}), vector({-0.44 * pi}),
                  in_units(sigma, pi, rho));
    const auto points = walk(walker);
    BOOST_TEST_CONTEXT("units " << sigma << ", " << pi << ", " << rho) {
      BOOST_TEST((walker.end().kind == End::Kind::bound));
      const auto folds = of_type(points, PointType::fold);
      BOOST_REQUIRE_EQUAL(folds.size(), 1u);
      BOOST_TEST(std::abs(folds[0].p[0] / pi - 1.0) < 1e-12);
      BOOST_TEST(std::abs(folds[0].x[0] / sigma - 0.3) < 1e-9);
      if (points_in_ones == 0) points_in_ones = points.size();
      // Rounding of F's difference in p may move a step length.
      BOOST_TEST(std::abs(double(points.size()) - double(points_in_ones)) <= 1.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(precision_of_a_fold_found_with_a_loose_tolerance_is_true) {
  // The cubic term spoils what is exact for a parabola.
  for (const double tolerance : {1e-5, 1e-7, 1e-10}) {
    const auto problem = std::make_shared<DenseProblem>(1, [](const Vector& x, const Vector& p) {
      return vector({p[0] - 1.0 + std::pow(x[0] - 0.3, 2) + std::pow(x[0] - 0.3, 3)});
    });
    Options options;
    options.lower = 0.0;
    options.newton_tolerance = tolerance;
    options.residual_tolerance = 1.0;
    Walker walker(problem, vector({-0.2}), vector({0.875}), options);
    const auto folds = of_type(walk(walker), PointType::fold);
    BOOST_REQUIRE(!folds.empty());
    BOOST_TEST(std::abs(folds[0].p[0] - 1.0) <= folds[0].precision + 1e-15);  // an ulp or two of p itself
  }
}

BOOST_AUTO_TEST_CASE(starts_on_a_fold) {
  // At the default tolerance x is known to the square root of p's rounding.
  Walker walker(parabola(1.0, 1.0, 1.0), vector({0.3}), vector({1.0}), in_units(1.0, 1.0, 1.0));
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_TEST(points.size() > 5u);
  for (const Point& point : points)
    BOOST_TEST(std::abs(point.p[0] - 1.0 + std::pow(point.x[0] - 0.3, 2)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(starts_on_a_branch_point_and_names_it) {
  const auto problem = std::make_shared<DenseProblem>(
      2,
      [](const Vector& x, const Vector& p) {
        return vector({-p[0] * x[0] + std::pow(x[0], 3), x[1] - std::sin(p[0])});
      },
      [](const Vector& x, const Vector& p) {
        Matrix j = Matrix::Identity(2, 2);
        j(0, 0) = -p[0] + 3.0 * x[0] * x[0];
        return j;
      });
  Options options;
  options.upper = 1.0;
  Walker walker(problem, vector({0.0, 0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_REQUIRE(points.size() > 2u);
  BOOST_TEST((points[0].type == PointType::start));
  BOOST_TEST((points[1].type == PointType::branch_point));
  BOOST_TEST(of_type(points, PointType::branch_point).size() == 1u);
  BOOST_TEST(points.back().p[0] == 1.0);
  BOOST_TEST(std::abs(points.back().x[0]) < 1e-9);
  BOOST_TEST(switch_branch(points[1], options).arms.size() == 2u);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_looked_for_is_said) {
  class Blind : public AlgebraicProblem {
   public:
    using AlgebraicProblem::AlgebraicProblem;
    int determinant_sign() override { return 0; }
    std::shared_ptr<Problem> clone() const override { return std::make_shared<Blind>(*this); }
  };
  auto problem = std::make_shared<Blind>(
      1, [](const Vector& x, const Vector& p) { return vector({-p[0] * x[0] + std::pow(x[0], 3)}); });
  problem->index_known = false;
  Options options;
  options.upper = 1.0;
  DiagramObserver silent;
  const Diagram diagram = trace_diagram(problem, vector({0.0}), vector({-1.0}), options, {}, silent);
  BOOST_REQUIRE_EQUAL(diagram.notes.size(), 1u);
  BOOST_TEST(diagram.notes[0].find("neither index nor determinant_sign") != std::string::npos);
}

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

BOOST_AUTO_TEST_CASE(sparse_and_dense_adaptors_agree_and_derivatives_are_checked) {
  const int n = 15;
  const double h = 1.0 / (n + 1);
  const auto residual = [=](const Vector& u, const Vector& p) {
    Vector f(n);
    for (int i = 0; i < n; ++i)
      f[i] = (2.0 * u[i] - (i > 0 ? u[i - 1] : 0.0) - (i + 1 < n ? u[i + 1] : 0.0)) / (h * h) -
             p[0] * std::exp(u[i]);
    return f;
  };
  const auto sparse_jacobian = [=](const Vector& u, const Vector& p) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, 2.0 / (h * h) - p[0] * std::exp(u[i]));
      if (i > 0) entries.emplace_back(i, i - 1, -1.0 / (h * h));
      if (i + 1 < n) entries.emplace_back(i, i + 1, -1.0 / (h * h));
    }
    SparseProblem::Sparse j(n, n);
    j.setFromTriplets(entries.begin(), entries.end());
    return j;
  };
  const auto dense = std::make_shared<DenseProblem>(n, residual);
  const auto sparse = std::make_shared<SparseProblem>(n, residual, sparse_jacobian, true);
  const auto fold = [&](std::shared_ptr<Problem> problem) {
    Options options;
    options.lower = 1.0;
    options.step_max = 1.0;
    options.residual_scale = 1.0 / (h * h);
    Walker walker(std::move(problem), Vector::Zero(n), vector({1.0}), options);
    const auto folds = of_type(walk(walker), PointType::fold);
    BOOST_REQUIRE_EQUAL(folds.size(), 1u);
    BOOST_TEST(folds[0].index == 0);
    BOOST_TEST(folds[0].index_after == 1);
    return folds[0].p[0];
  };
  BOOST_TEST(std::abs(fold(dense) - fold(sparse)) < 1e-10);
  const Vector u = Vector::LinSpaced(n, 0.1, 0.9), p = vector({2.0});
  const auto product = [&](const Vector& x, const Vector& q, const Vector& v) {
    return Vector(sparse_jacobian(x, q) * v);
  };
  BOOST_TEST(jacobian_error(residual, product, u, p) < 1e-7);
  const auto wrong = [&](const Vector& x, const Vector& q, const Vector& v) {
    return Vector(product(x, q, v) + 0.01 * v / (h * h));
  };
  BOOST_TEST(jacobian_error(residual, wrong, u, p) > 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
