#pragma once

#include <Eigen/Dense>
#include <vector>

namespace windlass::chain {

/// Bunch-Kaufman factorisation of a symmetric indefinite matrix (LAPACK dsytrf): its inertia and its inverse.
class SymmetricFactors {
 public:
  SymmetricFactors() = default;
  /// Reads the lower triangle. A matrix that is singular to the last bit is moved by its rounding, so that an inverse exists
  /// whose largest eigenvalue belongs to the null vector.
  explicit SymmetricFactors(Eigen::MatrixXd a);
  int negative() const { return negative_; }  ///< eigenvalues below zero
  double least_pivot() const;                 ///< size of the least pivot
  void solve(Eigen::VectorXd& rhs) const;     ///< in place

 private:
  Eigen::MatrixXd factors_;
  std::vector<int> pivot_;
  int negative_ = 0;
};

/// Eigenvalues of a dense symmetric matrix that are next to nothing, with their vectors (LAPACK dsyevr: of a thousand rows the others'
/// vectors would be nine tenths of the work).
struct SmallEigenvalues {
  int negative = 0;         ///< of all eigenvalues
  Eigen::VectorXd values;   ///< those of size `close` times the largest, and less
  Eigen::MatrixXd vectors;  ///< a column each
};

/// @throws std::domain_error where LAPACK finds none: the matrix is not finite
SmallEigenvalues small_eigenvalues(const Eigen::MatrixXd& a, double close);

}  // namespace windlass::chain
