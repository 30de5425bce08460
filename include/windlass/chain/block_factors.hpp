#pragma once

#include <Eigen/Dense>
#include <memory>

#include "windlass/chain/block.hpp"

namespace windlass::chain {

/// Factors of the block that couples a chain's arcs. Small ones are dense; that of a rod with many touches, each of which knows its
/// neighbours only, is large and nearly empty: its cost grows with the number of touches, not with the cube of it.
class BlockFactors {
 public:
  BlockFactors();
  ~BlockFactors();
  BlockFactors(BlockFactors&&) noexcept;
  BlockFactors& operator=(BlockFactors&&) noexcept;

  void compute(const Block& block);
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, bool transposed) const;
  int determinant_sign() const { return sign_; }  ///< 0: singular

 private:
  struct Sparse;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_;
  std::unique_ptr<Sparse> sparse_;
  bool is_sparse_ = false;
  int sign_ = 0;
};

}  // namespace windlass::chain
