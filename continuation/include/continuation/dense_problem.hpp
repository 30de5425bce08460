#pragma once

#include <functional>
#include <memory>

#include "continuation/problem.hpp"

namespace continuation {

/// A small problem given by functions: F(x, p), and J = ∂F/∂x if there is a formula (differences otherwise).
/// Factored by LU with partial pivoting; the index comes from all eigenvalues of J, complex pairs told apart.
class DenseProblem : public Problem {
 public:
  using Residual = std::function<Vector(const Vector& x, const Vector& p)>;
  using Jacobian = std::function<Matrix(const Vector& x, const Vector& p)>;

  DenseProblem(Eigen::Index n, Residual residual, Jacobian jacobian = {});

  Eigen::Index size() const override { return n_; }
  Vector residual(const Vector& x, const Vector& p) override { return residual_(x, p); }
  Matrix jacobian(const Vector& x, const Vector& p) const;
  void factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C, const Matrix& D) override;
  Vector solve(const Vector& f, const Vector& g) override;
  Vector solve_transposed(const Vector& f, const Vector& g) override;
  int index(const Vector& x, const Vector& p) override;
  int complex_index(const Vector& x, const Vector& p) override;
  int determinant_sign() override;
  std::shared_ptr<Problem> clone() const override { return std::make_shared<DenseProblem>(*this); }

 private:
  Eigen::Index n_;
  Residual residual_;
  Jacobian jacobian_;
  Matrix j_;
  int complex_ = 0;
  Eigen::PartialPivLU<Matrix> lu_;
};

/// Largest relative difference between J v and a central difference of F, over a few directions v: 1e-6 or less where
/// the formula is right, about 1 where a term is wrong.
double jacobian_error(const DenseProblem::Residual& residual,
                      const std::function<Vector(const Vector& x, const Vector& p, const Vector& v)>& product,
                      const Vector& x, const Vector& p);
/// The same of a dense J.
double jacobian_error(DenseProblem& problem, const Vector& x, const Vector& p);

}  // namespace continuation
