#pragma once

#include "windlass/chain/block.hpp"

namespace windlass::chain {

/// Signs of the pivots of a symmetric indefinite matrix, which are those of its eigenvalues (Sylvester).
struct PivotSigns {
  int negative = 0;
  double least = 0.0;  ///< size of the least pivot
};

/// Of a matrix stored whole by Bunch-Kaufman (SymmetricFactors), of a large and nearly empty one by symmetric frontal elimination: unknowns are taken in an order of small bandwidth (reverse
/// Cuthill-McKee), and those that all their rows are known of are eliminated from the front of the others that they have met, by
/// pivots of one or two, as far as these pass a threshold (Duff and Reid 1983, ACM Trans. Math. Softw. 9, 302); what does not waits.
/// (MUMPS 5.5, which PETSc offers for this, loses negative pivots of two that it delays.)
/// @throws petsc::Error
PivotSigns pivot_signs(const Block& symmetric);

}  // namespace windlass::chain
