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

}  // namespace windlass::chain
