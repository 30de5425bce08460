#include "continuation/tangent.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace continuation {

double inner(const Problem& problem, const Tangent& a, const Tangent& b, const Scales& scales) {
  return problem.inner(a.x, b.x) / (scales.state * scales.state) +
         a.p * b.p / (scales.parameter * scales.parameter);
}

void normalise(const Problem& problem, Tangent& tangent, const Scales& scales) {
  const double length = std::sqrt(inner(problem, tangent, tangent, scales));
  if (!(length > 0.0) || !std::isfinite(length))
    throw std::runtime_error("the tangent is zero or not finite");
  tangent.x /= length;
  tangent.p /= length;
}

namespace {

Tangent bordered_tangent(Problem& problem, const Vector& x, const Vector& p, const Options& options,
                         const Vector& row, double corner) {
  const Eigen::Index n = problem.size();
  const Matrix column = problem.parameter_derivative(x, p, options.parameter);
  problem.factor(x, p, column, row, Matrix::Constant(1, 1, corner));
  const Vector t = problem.solve(Vector::Zero(n), Vector::Ones(1));
  Tangent tangent{t.head(n), t[n]};
  normalise(problem, tangent, options.scales());
  return tangent;
}

}  // namespace

Tangent first_tangent(Problem& problem, const Vector& x, const Vector& p, const Options& options,
                      int direction, double* sharp) {
  const Eigen::Index n = problem.size();
  Tangent tangent;
  if (sharp) *sharp = std::numeric_limits<double>::infinity();
  try {
    tangent = bordered_tangent(problem, x, p, options, Vector::Zero(n), 1.0);
    if (sharp) *sharp = options.parameter_scale / std::abs(tangent.p);
  } catch (const std::runtime_error&) {
    // A fold exactly at the start: any border not orthogonal to the kernel does.
    Vector row(n);
    for (Eigen::Index i = 0; i < n; ++i) row[i] = std::cos(1.0 + 2.399963229728653 * static_cast<double>(i));
    tangent = bordered_tangent(problem, x, p, options, row / std::sqrt(static_cast<double>(n)), 0.5);
  }
  if (tangent.p * direction < 0.0) {
    tangent.x = -tangent.x;
    tangent.p = -tangent.p;
  }
  return tangent;
}

Tangent next_tangent(Problem& problem, const Scales& scales) {
  const Eigen::Index n = problem.size();
  const Vector t = problem.solve(Vector::Zero(n), Vector::Ones(1));
  Tangent tangent{t.head(n), t[n]};
  normalise(problem, tangent, scales);
  return tangent;
}

}  // namespace continuation
