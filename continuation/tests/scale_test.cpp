// Units of state, parameter and residual; loose tolerances.
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/diagram.hpp"
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

BOOST_AUTO_TEST_CASE(arms_do_not_depend_on_units) {
  // A pitchfork whose branch also turns with p: ρ (p/π x/σ − (x/σ)³) beside ρ (y/σ − sin(p/π)).
  for (const auto& [sigma, pi, rho] : {std::array{1.0, 1.0, 1.0}, std::array{1e-8, 1e6, 1e8},
                                       std::array{1e6, 1.0, 1e-6}, std::array{1e-8, 1.0, 1.0}}) {
    const double s = sigma, l = pi, r = rho;
    const auto problem = std::make_shared<DenseProblem>(
        2,
        [=](const Vector& x, const Vector& p) {
          const double a = x[0] / s, q = p[0] / l;
          return vector({r * (-q * a + a * a * a), r * (x[1] / s - std::sin(q))});
        },
        [=](const Vector& x, const Vector& p) {
          const double a = x[0] / s;
          Matrix j = Matrix::Zero(2, 2);
          j(0, 0) = r / s * (-p[0] / l + 3.0 * a * a);
          j(1, 1) = r / s;
          return j;
        });
    Options options = in_units(s, l, r);
    options.upper = l;
    DiagramObserver silent;
    const Diagram diagram =
        trace_diagram(problem, vector({0.0, -s * std::sin(1.0)}), vector({-l}), options, {}, silent);
    BOOST_TEST_CONTEXT("units " << s << ", " << l << ", " << r) {
      BOOST_REQUIRE_EQUAL(diagram.specials.size(), 1u);
      BOOST_TEST(std::abs(diagram.specials[0].point.p[0] / l) < 1e-9);
      BOOST_REQUIRE_EQUAL(diagram.branches.size(), 3u);
      for (const Branch& branch : diagram.branches) BOOST_TEST((branch.end.kind == End::Kind::bound));
      BOOST_TEST(diagram.lost.empty());
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

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
