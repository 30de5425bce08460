// Localised patterns of the quadratic-cubic Swift-Hohenberg equation: folds close to each other in p, a loop that turns
// back where it crosses another branch (Burke and Knobloch 2007, Chaos 17, 037102).
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/sparse_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

constexpr int n = 400;

using Sparse = SparseProblem::Sparse;

/// (1 + ∂²)² on [0, length], mirrored at both ends.
Sparse linear_part(double length) {
  const double h = length / n;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 1.0);
    for (const int j : {i - 1, i + 1}) {
      entries.emplace_back(i, std::clamp(j, 0, n - 1), 1.0 / (h * h));
      entries.emplace_back(i, i, -1.0 / (h * h));
    }
  }
  Sparse a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a * a;
}

/// −(p u − (1 + ∂²)² u + 1.8 u² − u³), the gradient of an energy.
std::shared_ptr<SparseProblem> swift_hohenberg(const Sparse& linear) {
  return std::make_shared<SparseProblem>(
      n,
      [=](const Vector& u, const Vector& p) {
        const auto v = u.array();
        return Vector((linear * u).array() - p[0] * v - 1.8 * v * v + v * v * v);
      },
      [=](const Vector& u, const Vector& p) {
        Sparse j = linear;
        j.diagonal().array() += -p[0] - 3.6 * u.array() + 3.0 * u.array().square();
        return j;
      },
      true);
}

/// A few rolls at the left end, relaxed by the gradient's flow (half implicit) to a stable state.
Vector localised(const Sparse& linear, double length, double p) {
  Vector u(n);
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) * length / n;
    u[i] = x < 20.0 ? 1.3 * std::cos(x) : 0.0;
  }
  constexpr double dt = 0.5;
  Sparse implicit = dt * linear;
  implicit.diagonal().array() += 1.0 - dt * p;
  const Eigen::SimplicialLDLT<Sparse> solver(implicit);
  for (int k = 0; k < 400; ++k)
    u = solver.solve(Vector(u.array() + dt * (1.8 * u.array().square() - u.array().cube())));
  return u;
}

BOOST_AUTO_TEST_SUITE(snaking)

BOOST_AUTO_TEST_CASE(every_fold_of_the_loop_and_nothing_else_at_every_step) {
  // Nine wavelengths: the pattern that fills them is its own mirror image, and so the loop's two halves are images of
  // each other.
  const double length = 18.0 * M_PI;
  const Sparse linear = linear_part(length);
  const Vector u = localised(linear, length, -0.3);
  // F holds fourth differences, whose rounding is 16/h⁴ ε = 5e-12 in an entry of u, a tenth of that in p.
  constexpr double rounding = 1e-12;
  std::vector<double> first;
  for (const double step_max : {0.02, 0.05, 0.1}) {
    Options options;
    options.step = 0.01;
    options.step_max = step_max;
    Walker walker(swift_hohenberg(linear), u, vector({-0.3}), options);
    const auto points = walk(walker);
    auto folds = of_type(points, PointType::fold);
    BOOST_TEST_CONTEXT("step_max " << step_max) {
      BOOST_TEST((walker.end().kind == End::Kind::closed));
      BOOST_TEST(of_type(points, PointType::branch_point).size() == 2u);
      BOOST_REQUIRE_EQUAL(folds.size(), 32u);
      std::sort(folds.begin(), folds.end(), [](const Point& a, const Point& b) { return a.p[0] < b.p[0]; });
      for (std::size_t i = 0; i < folds.size(); i += 2) {
        const Point &one = folds[i], &image = folds[i + 1];
        BOOST_TEST(image.p[0] - one.p[0] <= one.precision + image.precision + rounding);
        BOOST_TEST((one.x - image.x.reverse()).norm() < 1e-5 * one.x.norm());
      }
      for (std::size_t i = 0; i < folds.size(); ++i) {
        if (first.size() < folds.size()) first.push_back(folds[i].p[0]);
        BOOST_TEST(std::abs(folds[i].p[0] - first[i]) <= 2.0 * folds[i].precision + rounding);
        BOOST_TEST(folds[i].precision < 1e-11);
        BOOST_TEST(std::abs(folds[i].index - folds[i].index_after) == 1);
        BOOST_TEST(folds[i].note == "");
      }
    }
    BOOST_TEST_MESSAGE("step_max " << step_max << ": " << points.size() << " points, " << folds.size()
                                   << " folds");
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
