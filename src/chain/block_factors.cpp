#include "windlass/chain/block_factors.hpp"

namespace windlass::chain {

void BlockFactors::compute(const Block& block) {
  is_sparse_ = block.by_columns();
  if (!is_sparse_) {
    dense_.compute(block.stored_whole());
    const auto diagonal = dense_.matrixLU().diagonal();
    sign_ = diagonal.cwiseAbs().minCoeff() == 0.0 ? 0 : (diagonal.array() < 0.0).count() % 2 == 1 ? -1 : 1;
    sign_ *= static_cast<int>(dense_.permutationP().determinant());
    return;
  }
  block.copy_to(sparse_.matrix());
  sign_ = sparse_.compute();
}

Eigen::VectorXd BlockFactors::solve(const Eigen::VectorXd& rhs, bool transposed) const {
  if (!is_sparse_) return transposed ? Eigen::VectorXd(dense_.transpose().solve(rhs)) : dense_.solve(rhs);
  return sparse_.solve(rhs, transposed);
}

}  // namespace windlass::chain
