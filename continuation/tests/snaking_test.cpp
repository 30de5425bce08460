// Localised patterns of the quadratic-cubic Swift-Hohenberg equation: folds close to each other in p, a loop that turns
// back where it crosses another branch (Burke and Knobloch 2007, Chaos 17, 037102).
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <iomanip>

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
  const double length = 60.0;
  const Sparse linear = linear_part(length);
  const Vector u = localised(linear, length, -0.3);
  for (const double step_max : {0.02, 0.05, 0.1}) {
    Options options;
    options.step = 0.01;
    options.step_max = step_max;
    options.max_points = 6000;
    Walker walker(swift_hohenberg(linear), u, vector({-0.3}), options);
    const auto points = walk(walker);
    const auto folds = of_type(points, PointType::fold), crossings = of_type(points, PointType::branch_point);
    BOOST_TEST_MESSAGE("step_max " << step_max << ": " << points.size() << " points, " << folds.size()
                                   << " folds, " << crossings.size() << " branch points, "
                                   << walker.end().reason);
    for (const Point& point : points)
      if (point.type != PointType::regular)
        BOOST_TEST_MESSAGE(name(point.type)
                           << " p " << std::setprecision(15) << point.p[0] << " +- " << point.precision
                           << " rms " << point.x.norm() / 20.0 << " index " << point.index << " "
                           << point.index_after << " s " << point.path_length << " " << point.note);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
