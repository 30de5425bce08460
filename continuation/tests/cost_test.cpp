// What watching over the steps costs, in factorisations.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/diagram.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

/// Counts over all clones.
struct Counting : AlgebraicProblem {
  using AlgebraicProblem::AlgebraicProblem;
  void factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C, const Matrix& D) override {
    ++*count;
    AlgebraicProblem::factor(x, p, B, C, D);
  }
  std::shared_ptr<Problem> clone() const override { return std::make_shared<Counting>(*this); }
  std::shared_ptr<int> count = std::make_shared<int>(0);
};

int factorisations(const std::shared_ptr<Counting>& problem, const Vector& x, double p,
                   const Options& options) {
  DiagramObserver silent;
  const Diagram diagram = trace_diagram(problem, x, vector({p}), options, {}, silent);
  BOOST_TEST(diagram.lost.empty());
  return *problem->count;
}

int bratu() {
  constexpr int n = 20;
  constexpr double h = 1.0 / (n + 1);
  Options options;
  options.lower = 0.5;
  options.residual_tolerance = 1e-6;
  const auto problem = std::make_shared<Counting>(n, [=](const Vector& u, const Vector& p) {
    Vector f(n);
    for (int i = 0; i < n; ++i)
      f[i] = (2.0 * u[i] - (i > 0 ? u[i - 1] : 0.0) - (i + 1 < n ? u[i + 1] : 0.0)) / (h * h) -
             p[0] * std::exp(u[i]);
    return f;
  });
  return factorisations(problem, Vector::Zero(n), 0.5, options);
}

/// Buckling of a chain of four links with springs in its joints: four pitchforks and their arms.
int chain() {
  Options options;
  options.upper = 4.5;
  options.step_max = 0.2;
  const auto problem = std::make_shared<Counting>(4, [](const Vector& a, const Vector& p) {
    Vector f(4);
    for (int i = 0; i < 4; ++i) {
      const double left = i > 0 ? a[i] - a[i - 1] : 0.0, right = i + 1 < 4 ? a[i + 1] - a[i] : 0.0;
      f[i] = left - right - p[0] * std::sin(a[i]) + 0.1 * a[i];
    }
    return f;
  });
  return factorisations(problem, Vector::Zero(4), 0.05, options);
}

/// A long way without special points.
int wave() {
  Options options;
  options.upper = 30.0;
  const auto problem = std::make_shared<Counting>(1, [](const Vector& x, const Vector& p) {
    return vector({x[0] + 0.1 * std::pow(x[0], 3) - 3.0 * std::sin(p[0])});
  });
  return factorisations(problem, vector({0.0}), 0.0, options);
}

BOOST_AUTO_TEST_SUITE(cost)

BOOST_AUTO_TEST_CASE(steps_are_watched_over_for_less_than_a_twentieth) {
  // The same walks with the library as it was before steps were watched over (commit fc5673e).
  constexpr int before_bratu = 88, before_chain = 1788, before_wave = 433;
  const int b = bratu(), c = chain(), w = wave();
  BOOST_TEST_MESSAGE("factorisations: " << b << ", " << c << ", " << w);
  BOOST_TEST(b <= 1.05 * before_bratu);
  BOOST_TEST(c <= 1.05 * before_chain);
  BOOST_TEST(w <= 1.05 * before_wave);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
