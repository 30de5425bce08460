#include "continuation/reduced.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace continuation {
namespace {

Matrix orthonormal(const Matrix& columns) {
  Eigen::HouseholderQR<Matrix> qr(columns);
  Matrix q = qr.householderQ() * Matrix::Identity(columns.rows(), columns.cols());
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    if (q.col(i).dot(columns.col(i)) < 0.0) q.col(i) = -q.col(i);  // keeps the orientation from pass to pass
  }
  return q;
}

void scale_to_metric(const Problem& problem, Matrix& columns, double state_scale) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double length = std::sqrt(problem.inner(columns.col(i), columns.col(i)));
    if (!(length > 0.0) || !std::isfinite(length)) throw std::runtime_error("a null vector is not finite");
    columns.col(i) *= state_scale / length;
  }
}

}  // namespace

NullVectors null_vectors(Problem& problem, const Vector& x, const Vector& p, Eigen::Index k,
                         const Options& options, int passes) {
  const Eigen::Index n = problem.size();
  NullVectors null{Matrix(n, k), Matrix(n, k)};
  // Quasi-random starting borders: nothing smooth or symmetric is orthogonal to them.
  for (Eigen::Index j = 0; j < k; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double angle =
          1.0 + 2.399963229728653 * static_cast<double>(i) + 1.7 * static_cast<double>(j * (i + 1));
      null.right(i, j) = std::cos(angle);
      null.left(i, j) = std::cos(angle + 0.3);
    }
  }
  null.right = orthonormal(null.right);
  null.left = orthonormal(null.left);
  const Vector zero = Vector::Zero(n);
  const double size = options.residual_scale / options.state_scale;  // of J: pivots are chosen among equals
  const Matrix neutral = problem.neutral_motions(x, p);
  const Eigen::Index all = k + neutral.cols();
  Matrix left(n, all), right(n, all);
  for (int pass = 0; pass < passes; ++pass) {
    left << null.left, neutral;
    right << null.right, neutral;
    problem.factor(x, p, size * left, size * right, Matrix::Zero(all, all));
    for (Eigen::Index j = 0; j < k; ++j) {
      const Vector unit = Vector::Unit(all, j);
      null.right.col(j) = problem.solve(zero, unit).head(n);
      null.left.col(j) = problem.solve_transposed(zero, unit).head(n);
    }
    if (!null.right.allFinite() || !null.left.allFinite())
      throw std::runtime_error("a null vector is not finite");
    null.right = orthonormal(null.right);
    null.left = orthonormal(null.left);
  }
  scale_to_metric(problem, null.right, options.state_scale);
  return null;
}

double nearness(Problem& problem, const Vector& x, const Vector& p, const NullVectors& null,
                const Options& options) {
  const Vector row = null.right.col(0) / null.right.col(0).squaredNorm();
  problem.factor(x, p, options.residual_scale * null.left.leftCols(1), row, Matrix::Zero(1, 1));
  return problem.solve(Vector::Zero(problem.size()), Vector::Ones(1))[problem.size()];
}

Reduced::Reduced(Problem& problem, const Options& options, const Vector& x, const Vector& p, NullVectors null,
                 std::vector<Eigen::Index> parameters)
    : problem_(problem), options_(options), null_(std::move(null)), parameters_(std::move(parameters)) {
  const Eigen::Index k = null_.right.cols();
  const Matrix neutral = problem.neutral_motions(x, p);
  const Eigen::Index all = k + neutral.cols();
  borders_.psi.resize(problem.size(), all);
  borders_.c.resize(problem.size(), all);
  borders_.psi << null_.left, neutral;
  borders_.psi *= options.residual_scale;
  borders_.c << null_.right, neutral;
  for (Eigen::Index i = 0; i < k; ++i) borders_.c.col(i) /= null_.right.col(i).squaredNorm();
  borders_.d = Matrix::Zero(all, all);
  borders_.g = Vector::Zero(all);
  borders_.state_scale = options.state_scale;
  last_.it = Iterate{x, Vector::Zero(problem.size()), p, Vector::Zero(all)};
  last_.alpha = Vector::Zero(k);
}

double Reduced::Value::holding() const {
  const Eigen::Index held = it.y.size() - alpha.size();
  return held == 0 ? 0.0 : it.y.tail(held).cwiseAbs().maxCoeff();
}

std::optional<Reduced::Value> Reduced::at(const Vector& p, const Vector& alpha) {
  Value value;
  value.it = last_.it;
  if (last_.x_alpha.size() > 0) {
    Vector dx = last_.x_alpha * (alpha - last_.alpha);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      dx += last_.x_parameter.col(column) * (p[parameters_[j]] - last_.it.p[parameters_[j]]);
    }
    value.it.x = problem_.retract(value.it.x, dx);
    value.it.u += dx;
  }
  value.it.p = p;
  value.alpha = alpha;
  borders_.g.head(alpha.size()) = alpha;
  const CorrectorReport report = correct(problem_, borders_, value.it, options_);
  if (!report.converged) {
    failure_ = report.failure;
    return std::nullopt;
  }
  try {
    differentiate(value, report.factored_here);
  } catch (const std::domain_error& error) {
    failure_ = error.what();
    return std::nullopt;
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
    return std::nullopt;
  }
  last_ = value;
  return value;
}

void Reduced::differentiate(Value& value, bool factored) {
  const Eigen::Index n = problem_.size(), k = null_.right.cols(), all = borders_.g.size();
  const auto m = static_cast<Eigen::Index>(parameters_.size());
  if (!factored) problem_.factor(value.it.x, value.it.p, borders_.psi, borders_.c, borders_.d);
  // One more correction with this factorisation takes the state to roundoff; y is differenced later.
  const Vector residual = problem_.residual(value.it.x, value.it.p) + borders_.psi * value.it.y;
  const Vector correction = problem_.solve(-residual, borders_.g - borders_.c.transpose() * value.it.u);
  if (!correction.allFinite()) throw std::runtime_error("Newton's correction is not finite");
  value.it.x = problem_.retract(value.it.x, correction.head(n));
  value.it.u += correction.head(n);
  value.it.y += correction.tail(all);
  value.y_alpha.resize(k, k);
  value.x_alpha.resize(n, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const Vector derivative = problem_.solve(Vector::Zero(n), Vector::Unit(all, j));
    value.x_alpha.col(j) = derivative.head(n);
    value.y_alpha.col(j) = derivative.segment(n, k);
  }
  value.y_parameter.resize(k, m);
  value.x_parameter.resize(n, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Vector f =
        problem_.parameter_derivative(value.it.x, value.it.p, parameters_[static_cast<std::size_t>(j)]);
    const Vector derivative = problem_.solve(-f, Vector::Zero(all));
    value.x_parameter.col(j) = derivative.head(n);
    value.y_parameter.col(j) = derivative.segment(n, k);
  }
}

NullVectors Reduced::refreshed(const Value& value) {
  const Eigen::Index n = problem_.size(), k = null_.right.cols(), all = borders_.g.size();
  NullVectors null{orthonormal(value.x_alpha), Matrix(n, k)};
  for (Eigen::Index j = 0; j < k; ++j)
    null.left.col(j) = problem_.solve_transposed(Vector::Zero(n), Vector::Unit(all, j)).head(n);
  null.left = orthonormal(null.left);
  scale_to_metric(problem_, null.right, options_.state_scale);
  return null;
}

}  // namespace continuation
