#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <memory>

#include "continuation/problem.hpp"

namespace continuation {

/// A large problem given by F(x, p) and a sparse J = ∂F/∂x, factored by Eigen's SparseLU with the borders as dense rows
/// and columns.
///
/// Of a symmetric J (the second variation of an energy) the index is counted by an LDLᵀ factorisation of its own;
/// otherwise it is unknown, and the sign of the determinant shows branch points of odd multiplicity.
class SparseProblem : public Problem {
 public:
  using Sparse = Eigen::SparseMatrix<double>;
  using Residual = std::function<Vector(const Vector& x, const Vector& p)>;
  using Jacobian = std::function<Sparse(const Vector& x, const Vector& p)>;

  SparseProblem(Eigen::Index n, Residual residual, Jacobian jacobian, bool symmetric);
  ~SparseProblem() override;
  SparseProblem(const SparseProblem& other);

  Eigen::Index size() const override { return n_; }
  Vector residual(const Vector& x, const Vector& p) override { return residual_(x, p); }
  Sparse jacobian(const Vector& x, const Vector& p) const { return jacobian_(x, p); }
  void factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C, const Matrix& D) override;
  Vector solve(const Vector& f, const Vector& g) override;
  Vector solve_transposed(const Vector& f, const Vector& g) override;
  int index(const Vector& x, const Vector& p) override;
  int determinant_sign() override;
  std::shared_ptr<Problem> clone() const override { return std::make_shared<SparseProblem>(*this); }

 private:
  struct Factors;

  Eigen::Index n_;
  Residual residual_;
  Jacobian jacobian_;
  bool symmetric_;
  Sparse j_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace continuation
