#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <memory>

namespace windlass::chain {

/// LU factors of a sparse square matrix by UMFPACK, which chooses its pivots for size and emptiness together, and refines its
/// solutions. (Eigen's SparseLU and KLU, whose columns are ordered before any pivot is known, fill up to ten times as much of a
/// matrix with three touching strands.) What was analysed is kept while the pattern stays.
class SparseFactors {
 public:
  SparseFactors();
  ~SparseFactors();
  SparseFactors(SparseFactors&&) noexcept;
  SparseFactors& operator=(SparseFactors&&) noexcept;

  /// The matrix that compute() factors, n×n.
  Eigen::SparseMatrix<double>& matrix() { return matrix_; }
  /// @returns the determinant's sign, 0 where the matrix is singular
  int compute();
  /// K⁻¹ rhs, or K⁻ᵀ rhs. @param refined  at twice the cost and more
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, bool transposed = false, bool refined = true) const;

 private:
  struct Factors;
  Eigen::SparseMatrix<double> matrix_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace windlass::chain
