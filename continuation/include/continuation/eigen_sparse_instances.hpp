// The factorisation of sparse matrices of doubles, compiled once, as eigen_instances.hpp has it for dense ones; for the
// few files that use it.
#include <Eigen/SparseLU>

#ifndef INSTANCE_OF_EIGEN_SPARSE
#define INSTANCE_OF_EIGEN_SPARSE extern template
#endif

namespace Eigen {

INSTANCE_OF_EIGEN_SPARSE void SparseLU<SparseMatrix<double>, COLAMDOrdering<int>>::analyzePattern(
    const SparseMatrix<double>&);
INSTANCE_OF_EIGEN_SPARSE void SparseLU<SparseMatrix<double>, COLAMDOrdering<int>>::factorize(
    const SparseMatrix<double>&);
INSTANCE_OF_EIGEN_SPARSE bool SparseLU<SparseMatrix<double>, COLAMDOrdering<int>>::_solve_impl<
    VectorXd, VectorXd>(const MatrixBase<VectorXd>&, MatrixBase<VectorXd>&) const;

}  // namespace Eigen

#undef INSTANCE_OF_EIGEN_SPARSE
