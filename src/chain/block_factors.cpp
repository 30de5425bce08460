#include "windlass/chain/block_factors.hpp"

#include <umfpack.h>

#include <Eigen/SparseCore>
#include <array>
#include <vector>

namespace windlass::chain {

/// UMFPACK's: it chooses its pivots for size and emptiness together, and refines its solutions. (Eigen's SparseLU and KLU, whose
/// columns are ordered before any pivot is known, fill up to ten times as much of a matrix with three touching strands.)
struct BlockFactors::Sparse {
  Eigen::SparseMatrix<double> matrix;
  std::vector<int> columns, rows;  ///< of the pattern that was analysed
  void *symbolic = nullptr, *numeric = nullptr;

  Sparse() = default;
  Sparse(const Sparse&) = delete;
  Sparse& operator=(const Sparse&) = delete;
  ~Sparse() {
    umfpack_di_free_numeric(&numeric);
    umfpack_di_free_symbolic(&symbolic);
  }

  int size() const { return static_cast<int>(matrix.rows()); }

  /// Is the pattern that of before? It is kept.
  bool same_pattern() {
    const std::vector<int> now_columns(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1),
        now_rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    const bool same = now_columns == columns && now_rows == rows;
    columns = now_columns, rows = now_rows;
    return same;
  }

  /// @returns the determinant's sign, 0 where the matrix is singular
  int factor() {
    // Pivots are to be off the diagonal, where multipliers have nothing: an order for those on it fills ten times as much.
    std::array<double, UMFPACK_CONTROL> control;
    umfpack_di_defaults(control.data());
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_UNSYMMETRIC;
    const int *column = matrix.outerIndexPtr(), *row = matrix.innerIndexPtr();
    umfpack_di_free_numeric(&numeric);
    if (!same_pattern() || !symbolic) {
      umfpack_di_free_symbolic(&symbolic);
      if (umfpack_di_symbolic(size(), size(), column, row, matrix.valuePtr(), &symbolic, control.data(),
                              nullptr) != UMFPACK_OK)
        return 0;
    }
    if (umfpack_di_numeric(column, row, matrix.valuePtr(), symbolic, &numeric, control.data(), nullptr) !=
        UMFPACK_OK)
      return 0;
    double mantissa = 0.0, exponent = 0.0;
    umfpack_di_get_determinant(&mantissa, &exponent, numeric, nullptr);
    return (mantissa > 0.0) - (mantissa < 0.0);
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, bool transposed) const {
    Eigen::VectorXd out(rhs.size());
    umfpack_di_solve(transposed ? UMFPACK_At : UMFPACK_A, matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                     matrix.valuePtr(), out.data(), rhs.data(), numeric, nullptr, nullptr);
    return out;
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
  sign_ = sparse_->factor();
}

Eigen::VectorXd BlockFactors::solve(const Eigen::VectorXd& rhs, bool transposed) const {
  if (!is_sparse_) return transposed ? Eigen::VectorXd(dense_.transpose().solve(rhs)) : dense_.solve(rhs);
  return sparse_->solve(rhs, transposed);
}

}  // namespace windlass::chain
