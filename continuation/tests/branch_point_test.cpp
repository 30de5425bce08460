#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

Options between(double lower, double upper) {
  Options options;
  options.lower = lower;
  options.upper = upper;
  options.step = 0.07;
  return options;
}

BOOST_AUTO_TEST_SUITE(branch_points)

BOOST_AUTO_TEST_CASE(pitchfork_on_the_trivial_branch) {
  for (const bool index_known : {true, false}) {
    auto problem = scalar([](double x, const Vector& p) { return -(p[0] - 0.3) * x + x * x * x; });
    problem->index_known = index_known;
    Walker walker(problem, vector({0.0}), vector({-1.0}), between(-2.0, 1.0));
    const auto points = walk(walker);
    const auto found = of_type(points, PointType::branch_point);
    BOOST_REQUIRE_EQUAL(found.size(), 1u);
    BOOST_TEST(std::abs(found[0].p[0] - 0.3) < 1e-10);
    BOOST_TEST(std::abs(found[0].x[0]) < 1e-10);
    BOOST_TEST(found[0].precision < 1e-10);
    BOOST_TEST(found[0].multiplicity == 1);
    BOOST_REQUIRE(found[0].branch_point);
    const auto& tangents = found[0].branch_point->tangents;
    BOOST_REQUIRE_EQUAL(tangents.size(), 2u);
    BOOST_TEST(std::abs(std::abs(tangents[0].p) - 1.0) < 1e-5);     // the trivial branch
    BOOST_TEST(std::abs(std::abs(tangents[1].x[0]) - 1.0) < 1e-5);  // the pitchfork's arms
    if (index_known) {
      BOOST_TEST(found[0].index == 0);
      BOOST_TEST(found[0].index_after == 1);
    }
    BOOST_TEST(of_type(points, PointType::fold).empty());
  }
}

BOOST_AUTO_TEST_CASE(pitchfork_from_its_side_branch) {
  // Walking the parabola p = x² through the pitchfork: a branch point, not a fold, although dp/ds changes
  // sign.
  auto problem = scalar([](double x, const Vector& p) { return -p[0] * x + x * x * x; });
  Options options = between(-1.0, 1.0);
  options.direction = -1;
  Walker walker(problem, vector({0.8}), vector({0.64}), options);
  const auto points = walk(walker);
  const auto found = of_type(points, PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  BOOST_TEST(std::abs(found[0].p[0]) < 1e-10);
  BOOST_TEST(std::abs(found[0].x[0]) < 1e-7);
  BOOST_TEST(of_type(points, PointType::fold).empty());
  BOOST_TEST(points.back().p[0] == 1.0);
  BOOST_TEST(std::abs(points.back().x[0] + 1.0) < 1e-10);
}

BOOST_AUTO_TEST_CASE(imperfect_pitchfork_has_folds_only) {
  // p x - x³ + ε = 0: the branch from the left does not bifurcate, the detached one folds at p = 3
  // (ε/2)^(2/3).
  const double epsilon = 1e-3;
  const auto make = [&] {
    return scalar([epsilon](double x, const Vector& p) { return -p[0] * x + x * x * x - epsilon; });
  };
  Walker left(make(), vector({epsilon}), vector({-1.0}), between(-2.0, 1.0));
  const auto main_branch = walk(left);
  BOOST_TEST(of_type(main_branch, PointType::branch_point).empty());
  BOOST_TEST(of_type(main_branch, PointType::fold).empty());
  BOOST_TEST(main_branch.back().x[0] > 1.0);
  Options options = between(-2.0, 1.0);
  options.direction = -1;
  Walker detached(make(), vector({-0.95}), vector({0.9}), options);
  const auto points = walk(detached);
  const auto folds = of_type(points, PointType::fold);
  BOOST_REQUIRE_EQUAL(folds.size(), 1u);
  BOOST_TEST(std::abs(folds[0].p[0] - 3.0 * std::pow(0.5 * epsilon, 2.0 / 3.0)) < 1e-10);
  BOOST_TEST(of_type(points, PointType::branch_point).empty());
}

BOOST_AUTO_TEST_CASE(transcritical_off_the_axes) {
  // (x - sin p)(p - 0.4 + x - sin p): two curved branches crossing at p = 0.4, x = sin 0.4.
  auto problem = scalar([](double x, const Vector& p) {
    const double u = x - std::sin(p[0]);
    return u * (p[0] - 0.4 + u);
  });
  Walker walker(problem, vector({std::sin(-0.5)}), vector({-0.5}), between(-1.0, 1.2));
  const auto points = walk(walker);
  const auto found = of_type(points, PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  BOOST_TEST(std::abs(found[0].p[0] - 0.4) < 1e-10);
  BOOST_TEST(std::abs(found[0].x[0] - std::sin(0.4)) < 1e-10);
  // Slopes dx/dp: cos p along the branch, cos p - 1 on the other.
  const auto& tangents = found[0].branch_point->tangents;
  BOOST_REQUIRE_EQUAL(tangents.size(), 2u);
  BOOST_TEST(std::abs(tangents[0].x[0] / tangents[0].p - std::cos(0.4)) < 1e-3);
  BOOST_TEST(std::abs(tangents[1].x[0] / tangents[1].p - std::cos(0.4) + 1.0) < 1e-3);
}

BOOST_AUTO_TEST_CASE(double_kernel_is_one_point_of_multiplicity_two) {
  // λ z - |z|² z in R², rotated out of the axes and carried along z₀(λ); the index jumps by two.
  auto problem = std::make_shared<AlgebraicProblem>(3, [](const Vector& x, const Vector& p) {
    const double a = x[0], b = x[1], r = a * a + b * b, l = p[0] - 0.25;
    return vector({-l * a + r * a, -l * b + r * b, x[2] - p[0] * p[0]});
  });
  Walker walker(problem, vector({0.0, 0.0, 1.0}), vector({-1.0}), between(-2.0, 1.0));
  const auto points = walk(walker);
  const auto found = of_type(points, PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  BOOST_TEST(std::abs(found[0].p[0] - 0.25) < 1e-10);
  BOOST_TEST(found[0].multiplicity == 2);
  BOOST_TEST(found[0].index == 0);
  BOOST_TEST(found[0].index_after == 2);
  BOOST_REQUIRE(found[0].branch_point);
  const Matrix& kernel = found[0].branch_point->null.right;
  BOOST_TEST(kernel.cols() == 2);
  BOOST_TEST(kernel.row(2).norm() < 1e-8);
}

BOOST_AUTO_TEST_CASE(two_close_points_are_told_apart) {
  // Kernels at 0.25 and 0.25 + 1e-4 within one step: two simple points, not a double one.
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    const double l = p[0] - 0.25;
    return vector({-l * x[0] + std::pow(x[0], 3), -(l - 1e-4) * x[1] + std::pow(x[1], 3)});
  });
  Walker walker(problem, vector({0.0, 0.0}), vector({-1.0}), between(-2.0, 1.0));
  const auto found = of_type(walk(walker), PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 2u);
  BOOST_TEST(std::abs(found[0].p[0] - 0.25) < 1e-10);
  BOOST_TEST(std::abs(found[1].p[0] - 0.2501) < 1e-10);
  BOOST_TEST(found[0].index_after == 1);
  BOOST_TEST(found[1].index_after == 2);
}

BOOST_AUTO_TEST_CASE(fold_and_branch_point_in_one_step) {
  // The curve p = 1 - x² carries a pitchfork in y at x = 0.02: fold and branch point lie 0.02 apart.
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({p[0] - 1.0 + x[0] * x[0], -(x[0] - 0.02) * x[1] + std::pow(x[1], 3)});
  });
  Options options = between(-1.0, 2.0);
  options.step = options.step_max = 0.3;
  Walker walker(problem, vector({-1.0, 0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  const auto folds = of_type(points, PointType::fold);
  const auto found = of_type(points, PointType::branch_point);
  BOOST_REQUIRE_EQUAL(folds.size(), 1u);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  BOOST_TEST(std::abs(folds[0].p[0] - 1.0) < 1e-12);
  BOOST_TEST(std::abs(found[0].x[0] - 0.02) < 1e-9);
  BOOST_TEST(std::abs(found[0].p[0] - 0.9996) < 1e-10);
  BOOST_TEST(folds[0].path_length < found[0].path_length);
}

BOOST_AUTO_TEST_CASE(euler_strut_buckles_at_the_discrete_loads) {
  // θ'' + λ sin θ = 0, θ'(0) = θ'(1) = 0, θ antisymmetric part via pinned ends θ(0) = -θ(1) is avoided: θ(0)
  // = θ(1) = 0.
  const int n = 30;
  const double h = 1.0 / (n + 1);
  auto problem = std::make_shared<AlgebraicProblem>(
      n,
      [n, h](const Vector& u, const Vector& p) {
        Vector f(n);
        for (int i = 0; i < n; ++i) {
          const double left = i > 0 ? u[i - 1] : 0.0, right = i + 1 < n ? u[i + 1] : 0.0;
          f[i] = (2.0 * u[i] - left - right) / (h * h) - p[0] * std::sin(u[i]);
        }
        return f;
      },
      [n, h](const Vector& u, const Vector& p) {
        Matrix j = Matrix::Zero(n, n);
        for (int i = 0; i < n; ++i) {
          j(i, i) = 2.0 / (h * h) - p[0] * std::cos(u[i]);
          if (i > 0) j(i, i - 1) = -1.0 / (h * h);
          if (i + 1 < n) j(i, i + 1) = -1.0 / (h * h);
        }
        return j;
      });
  Options options = between(0.0, 100.0);
  options.step = options.step_max = 7.0;
  Walker walker(problem, Vector::Zero(n), vector({1.0}), options);
  const auto found = of_type(walk(walker), PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 3u);
  for (int k = 1; k <= 3; ++k) {
    const double s = std::sin(0.5 * k * M_PI * h);
    const Point& point = found[static_cast<std::size_t>(k - 1)];
    BOOST_TEST(std::abs(point.p[0] - 4.0 * s * s / (h * h)) < 1e-8);
    BOOST_TEST(point.index == k - 1);
    // The kernel is sin(k π s).
    const Vector mode =
        Vector::LinSpaced(n, h, 1.0 - h).unaryExpr([k](double t) { return std::sin(k * M_PI * t); });
    const Vector kernel = point.branch_point->null.right.col(0);
    BOOST_TEST(std::abs(std::abs(kernel.normalized().dot(mode.normalized())) - 1.0) < 1e-10);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
