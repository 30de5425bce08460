#include "windlass/chain/block_factors.hpp"

#include <Eigen/SparseCore>
#include <vector>

#include "continuation/eigen_sparse_instances.hpp"

namespace windlass::chain {

struct BlockFactors::Sparse {
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix matrix;
  // Its solvers of the transposed matrix are not const.
  mutable Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu;
  std::vector<int> columns, rows;  ///< of the pattern that was analysed

  /// Is the pattern that of before? It is kept.
  bool same_pattern() {
    const std::vector<int> now_columns(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1),
        now_rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    const bool same = now_columns == columns && now_rows == rows;
    columns = now_columns, rows = now_rows;
    return same;
  }
};

BlockFactors::BlockFactors() = default;
BlockFactors::~BlockFactors() = default;
BlockFactors::BlockFactors(BlockFactors&&) noexcept = default;
BlockFactors& BlockFactors::operator=(BlockFactors&&) noexcept = default;

void BlockFactors::compute(const Block& block) {
  is_sparse_ = block.by_columns();
  if (!is_sparse_) {
    dense_.compute(block.stored_whole());
    const auto diagonal = dense_.matrixLU().diagonal();
    sign_ = diagonal.cwiseAbs().minCoeff() == 0.0 ? 0 : (diagonal.array() < 0.0).count() % 2 == 1 ? -1 : 1;
    sign_ *= static_cast<int>(dense_.permutationP().determinant());
    return;
  }
  if (!sparse_) sparse_ = std::make_unique<Sparse>();
  block.copy_to(sparse_->matrix);
  if (!sparse_->same_pattern()) sparse_->lu.analyzePattern(sparse_->matrix);
  sparse_->lu.factorize(sparse_->matrix);
  sign_ = sparse_->lu.info() == Eigen::Success ? static_cast<int>(sparse_->lu.signDeterminant()) : 0;
}

Eigen::VectorXd BlockFactors::solve(const Eigen::VectorXd& rhs, bool transposed) const {
  if (!is_sparse_) return transposed ? Eigen::VectorXd(dense_.transpose().solve(rhs)) : dense_.solve(rhs);
  const auto solved = [&](const Eigen::VectorXd& f) {
    return transposed ? Eigen::VectorXd(sparse_->lu.transpose().solve(f))
                      : Eigen::VectorXd(sparse_->lu.solve(f));
  };
  // Pivots are chosen for emptiness, too: one refinement gives back what that costs.
  Eigen::VectorXd y = solved(rhs);
  const Eigen::VectorXd image =
      transposed ? Eigen::VectorXd(sparse_->matrix.transpose() * y) : Eigen::VectorXd(sparse_->matrix * y);
  return y + solved(rhs - image);
}

}  // namespace windlass::chain
