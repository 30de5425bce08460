#pragma once

#include <Eigen/Dense>

#include "windlass/chain/block.hpp"
#include "windlass/chain/sparse_factors.hpp"

namespace windlass::chain {

/// Factors of the block that couples a chain's arcs. Small ones are dense; that of a rod with many touches, each of which knows its
/// neighbours only, is large and nearly empty: its cost grows with the number of touches, not with the cube of it.
class BlockFactors {
 public:
  void compute(const Block& block);
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, bool transposed) const;
  int determinant_sign() const { return sign_; }  ///< 0: singular

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_;
  SparseFactors sparse_;
  bool is_sparse_ = false;
  int sign_ = 0;
};

}  // namespace windlass::chain
