#include "continuation/dense_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace continuation {
namespace {

// Step of a central difference in units of max(1, |x|): truncation h² and rounding ε/h are both 4e-11.
const double kStep = std::cbrt(std::numeric_limits<double>::epsilon());

}  // namespace

DenseProblem::DenseProblem(Eigen::Index n, Residual residual, Jacobian jacobian)
    : n_(n), residual_(std::move(residual)), jacobian_(std::move(jacobian)) {}

Matrix DenseProblem::jacobian(const Vector& x, const Vector& p) const {
  if (jacobian_) return jacobian_(x, p);
  Matrix j(n_, n_);
  Vector moved = x;
  for (Eigen::Index i = 0; i < n_; ++i) {
    const double h = kStep * std::max(1.0, std::abs(x[i]));
    moved[i] = x[i] + h;
    const Vector above = residual_(moved, p);
    moved[i] = x[i] - h;
    j.col(i) = (above - residual_(moved, p)) / (2.0 * h);
    moved[i] = x[i];
  }
  return j;
}

void DenseProblem::factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C,
                          const Matrix& D) {
  const Eigen::Index k = B.cols();
  j_ = jacobian(x, p);
  Matrix m(n_ + k, n_ + k);
  m << j_, B, C.transpose(), D;
  if (!m.allFinite()) throw std::runtime_error("the Jacobian is not finite");
  lu_.compute(m);
  if ((lu_.matrixLU().diagonal().array() == 0.0).any())
    throw std::runtime_error("the bordered matrix is singular");
}

Vector DenseProblem::solve(const Vector& f, const Vector& g) {
  Vector r(f.size() + g.size());
  r << f, g;
  return lu_.solve(r);
}

Vector DenseProblem::solve_transposed(const Vector& f, const Vector& g) {
  Vector r(f.size() + g.size());
  r << f, g;
  return lu_.transpose().solve(r);
}

int DenseProblem::index(const Vector&, const Vector&) {
  int real = 0;
  complex_ = 0;
  for (const std::complex<double>& value : Eigen::VectorXcd(j_.eigenvalues()))
    if (value.real() < 0.0) ++(value.imag() == 0.0 ? real : complex_);
  return real;
}

int DenseProblem::complex_index(const Vector&, const Vector&) { return complex_; }

int DenseProblem::determinant_sign() {
  double sign = lu_.permutationP().determinant();
  for (const double pivot : lu_.matrixLU().diagonal()) sign = pivot < 0.0 ? -sign : sign;
  return sign < 0.0 ? -1 : 1;
}

double jacobian_error(const DenseProblem::Residual& residual,
                      const std::function<Vector(const Vector&, const Vector&, const Vector&)>& product,
                      const Vector& x, const Vector& p) {
  double worst = 0.0;
  for (int k = 0; k < 3; ++k) {
    Vector v(x.size());  // no structure of the problem is orthogonal to it
    for (Eigen::Index i = 0; i < x.size(); ++i) v[i] = std::cos(1.0 + k + 2.399963229728653 * double(i));
    const double h = kStep * std::max(1.0, x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
    const Vector difference = (residual(x + h * v, p) - residual(x - h * v, p)) / (2.0 * h);
    const Vector formula = product(x, p, v);
    const double size = std::max(difference.norm(), formula.norm());
    if (size > 0.0) worst = std::max(worst, (difference - formula).norm() / size);
  }
  return worst;
}

double jacobian_error(DenseProblem& problem, const Vector& x, const Vector& p) {
  return jacobian_error(
      [&](const Vector& at, const Vector& q) { return problem.residual(at, q); },
      [&](const Vector& at, const Vector& q, const Vector& v) { return Vector(problem.jacobian(at, q) * v); },
      x, p);
}

}  // namespace continuation
