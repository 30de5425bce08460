#pragma once

#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "continuation/problem.hpp"

namespace continuation::testing {

/// A small dense problem given by its residual; J by central differences or given, everything else by LU.
class AlgebraicProblem : public Problem {
 public:
  using Residual = std::function<Vector(const Vector& x, const Vector& p)>;
  using Jacobian = std::function<Matrix(const Vector& x, const Vector& p)>;

  AlgebraicProblem(Eigen::Index n, Residual residual, Jacobian jacobian = {})
      : n_(n), residual_(std::move(residual)), jacobian_(std::move(jacobian)) {}

  Eigen::Index size() const override { return n_; }

  Vector residual(const Vector& x, const Vector& p) override {
    ++residuals;
    return residual_(x, p);
  }

  Matrix jacobian(const Vector& x, const Vector& p) {
    if (jacobian_) return jacobian_(x, p);
    Matrix j(n_, n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double h = 6e-6;
      const Vector e = Vector::Unit(n_, i);
      j.col(i) = (residual_(retract(x, h * e), p) - residual_(retract(x, -h * e), p)) / (2 * h);
    }
    return j;
  }

  void factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C, const Matrix& D) override {
    ++factorizations;
    const Eigen::Index k = B.cols();
    Matrix m(n_ + k, n_ + k);
    j_ = jacobian(x, p);
    m.topLeftCorner(n_, n_) = j_;
    m.topRightCorner(n_, k) = B;
    m.bottomLeftCorner(k, n_) = C.transpose();
    m.bottomRightCorner(k, k) = D;
    lu_.compute(m);
    if (!(std::abs(lu_.determinant()) > 1e-300)) throw std::runtime_error("the bordered matrix is singular");
    transposed_.compute(m.transpose());
  }

  Vector solve(const Vector& f, const Vector& g) override {
    Vector rhs(f.size() + g.size());
    rhs << f, g;
    return lu_.solve(rhs);
  }

  Vector solve_transposed(const Vector& f, const Vector& g) override {
    Vector rhs(f.size() + g.size());
    rhs << f, g;
    return transposed_.solve(rhs);
  }

  int index(const Vector&, const Vector&) override {
    if (!index_known) return -1;
    const Eigen::VectorXcd eigenvalues = j_.eigenvalues();
    int count = 0;
    for (const auto& value : eigenvalues) count += value.imag() == 0.0 && value.real() < 0.0;
    return count;
  }

  int determinant_sign() override { return lu_.determinant() < 0.0 ? -1 : 1; }

  double inner(const Vector& a, const Vector& b) const override { return a.dot(b); }

  std::vector<EventFunction> events(const Vector& x, const Vector& p) override {
    return events_of ? events_of(x, p) : std::vector<EventFunction>{};
  }

  std::optional<Transition> transition(std::size_t which, const Vector& x, const Vector& p) override {
    return transition_of ? transition_of(which, x, p) : std::nullopt;
  }

  std::optional<Transition> resettled(const Vector&, const Vector&, const Vector& x,
                                      const Vector& ahead) override {
    return resettled_of ? resettled_of(x, ahead) : std::nullopt;
  }

  std::optional<Vector> adapt(const Vector& x, const Vector& p) override {
    return adapt_of ? adapt_of(*this, x, p) : std::nullopt;
  }

  std::vector<Vector> kernel_directions(const Vector& x, const Vector& p, const Matrix& kernel) override {
    return directions_of ? directions_of(kernel) : Problem::kernel_directions(x, p, kernel);
  }

  Vector fingerprint(const Vector& x, const Vector& p) override {
    return fingerprint_of ? fingerprint_of(x, p) : x;
  }

  std::shared_ptr<Problem> clone() const override { return std::make_shared<AlgebraicProblem>(*this); }

  void set_size(Eigen::Index n) { n_ = n; }

  std::function<std::vector<EventFunction>(const Vector&, const Vector&)> events_of;
  std::function<std::optional<Transition>(std::size_t, const Vector&, const Vector&)> transition_of;
  std::function<std::optional<Transition>(const Vector&, const Vector&)> resettled_of;
  std::function<std::optional<Vector>(AlgebraicProblem&, const Vector&, const Vector&)> adapt_of;
  std::function<std::vector<Vector>(const Matrix&)> directions_of;
  std::function<Vector(const Vector&, const Vector&)> fingerprint_of;
  bool index_known = true;
  int factorizations = 0, residuals = 0;

 private:
  Eigen::Index n_;
  Residual residual_;
  Jacobian jacobian_;
  Matrix j_;
  Eigen::PartialPivLU<Matrix> lu_, transposed_;
};

inline Vector vector(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

/// One equation in one unknown.
inline std::shared_ptr<AlgebraicProblem> scalar(std::function<double(double, const Vector&)> f) {
  return std::make_shared<AlgebraicProblem>(
      1, [f = std::move(f)](const Vector& x, const Vector& p) { return vector({f(x[0], p)}); });
}

}  // namespace continuation::testing
