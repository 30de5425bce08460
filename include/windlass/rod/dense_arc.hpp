#pragma once

#include "windlass/bvp/arc.hpp"

namespace windlass::rod {

/// An arc whose matrix is full and not symmetric: condensed by dense algebra.
class DenseArc : public bvp::Arc {
 public:
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void reduce(double* rhs_interior, bvp::EndsVector& rhs_ends) const override;
  void reduce_transposed(double* rhs_interior, bvp::EndsVector& rhs_ends) const override;
  void expand(double* interior, const bvp::EndsVector& solution_ends) const override;
  void expand_transposed(double* interior, const bvp::EndsVector& solution_ends) const override;
  int negative_pivots() const override { return negative_; }
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;

 protected:
  /// Derivatives of the whole arc's gradient (interior, then ends), to matrix_.
  virtual void linearise(const bvp::ArcPoint& at) const = 0;
  mutable Eigen::MatrixXd matrix_;  // work space

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> inner_;
  Eigen::MatrixXd solved_, weighted_;  ///< K_ii⁻¹ K_ie, K_ei
  Eigen::MatrixXd solved_left_;        ///< K_ii⁻ᵀ K_eiᵀ
  int negative_ = 0;
};

}  // namespace windlass::rod
