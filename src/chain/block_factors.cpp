#include "windlass/chain/block_factors.hpp"

#include <Eigen/SparseCore>
#include <algorithm>

#include "continuation/eigen_sparse_instances.hpp"

namespace windlass::chain {

struct BlockFactors::Sparse {
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix matrix;
  // Its solvers of the transposed matrix are not const.
  mutable Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu;
  bool known = false;  ///< the pattern, from before

  bool same_pattern(const Matrix& other) const {
    return known && other.nonZeros() == matrix.nonZeros() && other.cols() == matrix.cols() &&
           std::equal(other.outerIndexPtr(), other.outerIndexPtr() + other.cols() + 1,
                      matrix.outerIndexPtr()) &&
           std::equal(other.innerIndexPtr(), other.innerIndexPtr() + other.nonZeros(),
                      matrix.innerIndexPtr());
  }
};

BlockFactors::BlockFactors() = default;
BlockFactors::~BlockFactors() = default;
BlockFactors::BlockFactors(BlockFactors&&) noexcept = default;
BlockFactors& BlockFactors::operator=(BlockFactors&&) noexcept = default;

void BlockFactors::compute(const Eigen::MatrixXd& block) {
  constexpr Eigen::Index large = 300;  // below that the dense factors are as fast
  is_sparse_ = block.rows() > large;
  if (!is_sparse_) {
    dense_.compute(block);
    const auto diagonal = dense_.matrixLU().diagonal();
    sign_ = diagonal.cwiseAbs().minCoeff() == 0.0 ? 0 : (diagonal.array() < 0.0).count() % 2 == 1 ? -1 : 1;
    sign_ *= static_cast<int>(dense_.permutationP().determinant());
    return;
  }
  Sparse::Matrix matrix = block.sparseView(0.0, 0.0);
  matrix.makeCompressed();
  if (!sparse_) sparse_ = std::make_unique<Sparse>();
  const bool known = sparse_->same_pattern(matrix);
  sparse_->matrix = std::move(matrix);
  if (!known) sparse_->lu.analyzePattern(sparse_->matrix);
  sparse_->lu.factorize(sparse_->matrix);
  sparse_->known = true;
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
