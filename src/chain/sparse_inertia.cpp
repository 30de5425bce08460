#include "sparse_inertia.hpp"

#include "windlass/petsc/handles.hpp"

namespace windlass::chain {

int negative_eigenvalues(const Block& symmetric) {
  using petsc::check;
  Eigen::SparseMatrix<double> entries;
  symmetric.copy_to(entries);
  const petsc::MatHandle matrix = petsc::symmetric(entries);
  petsc::MatHandle factors;
  check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  // Not with MUMPS' detection of null pivots: version 5.5 miscounts then.
  check(MatGetFactor(matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factors.put()));
  MatFactorInfo unused;
  check(MatFactorInfoInitialize(&unused));
  check(MatCholeskyFactorSymbolic(factors, matrix, nullptr, &unused));
  check(MatCholeskyFactorNumeric(factors, matrix, &unused));
  PetscInt negative = 0;
  check(MatGetInertia(factors, &negative, nullptr, nullptr));
  return static_cast<int>(negative);
}

}  // namespace windlass::chain
