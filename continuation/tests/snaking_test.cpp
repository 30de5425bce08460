// Localised patterns of the quadratic-cubic Swift-Hohenberg equation: folds close to each other in p, a loop that turns
// back where it crosses another branch (Burke and Knobloch 2007, Chaos 17, 037102).
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

/// −(p u − (1 + ∂²)² u + 1.6 u² − u³) on [0, L], mirrored at both ends; the second variation of an energy.
std::shared_ptr<SparseProblem> swift_hohenberg(double length) {
  using Sparse = SparseProblem::Sparse;
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
  const Sparse linear = a * a;
  return std::make_shared<SparseProblem>(
      n,
      [=](const Vector& u, const Vector& p) {
        const auto v = u.array();
        return Vector((linear * u).array() - p[0] * v - 1.6 * v * v + v * v * v);
      },
      [=](const Vector& u, const Vector& p) {
        Sparse j = linear;
        j.diagonal().array() += -p[0] - 3.2 * u.array() + 3.0 * u.array().square();
        return j;
      },
      true);
}

BOOST_AUTO_TEST_SUITE(snaking)

BOOST_AUTO_TEST_CASE(every_fold_of_the_loop_and_nothing_else_at_every_step) {
  const double length = 60.0;
  Vector u(n);
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) * length / n;
    u[i] = 1.3 * std::exp(-x * x / 100.0) * std::cos(x);
  }
  for (const double step_max : {0.02, 0.05, 0.1}) {
    Options options;
    options.step = 0.01;
    options.step_max = step_max;
    options.max_points = 6000;
    Walker walker(swift_hohenberg(length), u, vector({-0.25}), options);
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
