#pragma once

#include "windlass/chain/block.hpp"

namespace windlass::chain {

/// Number of negative eigenvalues of a symmetric indefinite matrix kept by columns, by MUMPS' sparse Bunch-Kaufman
/// factorisation. @throws petsc::Error
int negative_eigenvalues(const Block& symmetric);

}  // namespace windlass::chain
