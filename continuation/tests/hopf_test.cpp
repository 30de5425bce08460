// Problems that are no gradients: complex pairs are told from real eigenvalues.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/diagram.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

BOOST_AUTO_TEST_SUITE(hopf)

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

BOOST_AUTO_TEST_CASE(every_branch_point_of_the_brusselator_on_an_interval) {
  // u'' D/l² + A − (B + 1) u + u² v = 0, v'' E/l² + B u − u² v = 0 on n nodes, u = A and v = B/A at the ends. Mode k of
  // the difference operator, eigenvalue κ, is neutral at B = (1 + D κ)(A² + E κ)/(E κ).
  constexpr int n = 40;
  constexpr double A = 2.0, D = 0.01, E = 0.05, h = 1.0 / (n + 1);
  const auto problem = std::make_shared<DenseProblem>(2 * n, [=](const Vector& x, const Vector& p) {
    Vector f(2 * n);
    for (int i = 0; i < n; ++i) {
      const double u = x[i], v = x[n + i];
      const double u_l = i > 0 ? x[i - 1] : A, u_r = i + 1 < n ? x[i + 1] : A;
      const double v_l = i > 0 ? x[n + i - 1] : p[0] / A, v_r = i + 1 < n ? x[n + i + 1] : p[0] / A;
      f[i] = -(D * (u_l - 2.0 * u + u_r) / (h * h) + A - (p[0] + 1.0) * u + u * u * v);
      f[n + i] = -(E * (v_l - 2.0 * v + v_r) / (h * h) + p[0] * u - u * u * v);
    }
    return f;
  });
  constexpr double upper = 9.8;  // eight neutral modes, 0.29 to 1.5 apart
  std::vector<double> exact, pairs;
  for (int k = 1; k <= n; ++k) {
    const double kappa = std::pow(2.0 / h * std::sin(0.5 * k * M_PI * h), 2);
    const double zero = (1.0 + D * kappa) * (A * A + E * kappa) / (E * kappa);
    const double pair = 1.0 + A * A + (D + E) * kappa;
    if (zero < upper) exact.push_back(zero);
    // det > 0 where the trace vanishes: the pair is complex there
    if (pair < upper && pair < zero) pairs.push_back(pair);
  }
  std::sort(exact.begin(), exact.end());
  BOOST_REQUIRE_EQUAL(exact.size(), 8u);
  Vector start(2 * n);
  start << Vector::Constant(n, A), Vector::Constant(n, 1.0 / A);
  for (const double step_max : {0.1, 0.5}) {
    Options options;
    options.upper = upper;
    options.step_max = step_max;
    Walker walker(problem, start, vector({1.0}), options);
    const auto points = walk(walker);
    const auto found = of_type(points, PointType::branch_point), hopf = of_type(points, PointType::hopf);
    BOOST_TEST_CONTEXT("step_max " << step_max) {
      BOOST_REQUIRE_EQUAL(found.size(), exact.size());
      for (std::size_t i = 0; i < exact.size(); ++i) BOOST_TEST(std::abs(found[i].p[0] - exact[i]) < 1e-8);
      BOOST_REQUIRE_EQUAL(hopf.size(), pairs.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) BOOST_TEST(std::abs(hopf[i].p[0] - pairs[i]) < 1e-8);
    }
  }
}

BOOST_AUTO_TEST_CASE(two_branch_points_in_one_step_without_an_index) {
  // Modes of u'' + p (u − u³) = 0 are neutral at p = κ_k; det J is the same before and after two of them.
  constexpr int n = 30;
  constexpr double h = 1.0 / (n + 1);
  auto problem = std::make_shared<AlgebraicProblem>(n, [=](const Vector& u, const Vector& p) {
    Vector f(n);
    for (int i = 0; i < n; ++i) {
      const double left = i > 0 ? u[i - 1] : 0.0, right = i + 1 < n ? u[i + 1] : 0.0;
      f[i] = 0.01 * (2.0 * u[i] - left - right) / (h * h) - p[0] * (u[i] - std::pow(u[i], 3));
    }
    return f;
  });
  problem->index_known = false;
  for (const double step_max : {0.3, 3.0}) {
    Options options;
    options.upper = 4.5;
    options.step_max = step_max;
    Walker walker(problem, Vector::Zero(n), vector({0.02}), options);
    const auto found = of_type(walk(walker), PointType::branch_point);
    BOOST_TEST_CONTEXT("step_max " << step_max) {
      BOOST_REQUIRE_EQUAL(found.size(), 6u);
      for (int k = 1; k <= 6; ++k) {
        const double exact = 0.01 * std::pow(2.0 / h * std::sin(0.5 * k * M_PI * h), 2);
        BOOST_TEST(std::abs(found[static_cast<std::size_t>(k - 1)].p[0] - exact) < 1e-8);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
