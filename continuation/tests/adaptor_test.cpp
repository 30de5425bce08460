// Problems made of functions.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/sparse_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

BOOST_AUTO_TEST_SUITE(adaptors)

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
