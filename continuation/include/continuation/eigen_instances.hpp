// The templates of Eigen for matrices of doubles that take long to compile: most of the time of a file that
// multiplied or factored a matrix went into compiling the same few of them once more. Declared here, in the
// precompiled headers of whatever links this library; defined by eigen_instances.cpp, which includes this file
// once more, hence no guard. Without it everything works as well. Only for code compiled for the same processor
// as this library.
#include <Eigen/Dense>

#ifndef INSTANCE_OF_EIGEN
#define INSTANCE_OF_EIGEN extern template
#endif

namespace Eigen {

INSTANCE_OF_EIGEN void PartialPivLU<MatrixXd>::compute();
INSTANCE_OF_EIGEN void FullPivLU<MatrixXd>::computeInPlace();
INSTANCE_OF_EIGEN void HouseholderQR<MatrixXd>::computeInPlace();
INSTANCE_OF_EIGEN void ColPivHouseholderQR<MatrixXd>::computeInPlace();
INSTANCE_OF_EIGEN void ColPivHouseholderQR<MatrixXd>::_solve_impl<VectorXd, VectorXd>(const VectorXd&,
                                                                                      VectorXd&) const;
INSTANCE_OF_EIGEN SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute<MatrixXd>(
    const EigenBase<MatrixXd>&, int);
INSTANCE_OF_EIGEN EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&,
                                                                                  bool);
INSTANCE_OF_EIGEN void HouseholderSequence<MatrixXd, VectorXd>::evalTo<MatrixXd, VectorXd>(MatrixXd&,
                                                                                           VectorXd&) const;
INSTANCE_OF_EIGEN void HouseholderSequence<MatrixXd, VectorXd>::applyThisOnTheLeft<MatrixXd, VectorXd>(
    MatrixXd&, VectorXd&, bool) const;
INSTANCE_OF_EIGEN void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheLeft<
    Block<const MatrixXd, Dynamic, 1>>(const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);
INSTANCE_OF_EIGEN void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheRight<
    Block<const MatrixXd, Dynamic, 1>>(const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);
INSTANCE_OF_EIGEN EigenSolver<MatrixXd>::EigenvectorsType EigenSolver<MatrixXd>::eigenvectors() const;

namespace internal {

INSTANCE_OF_EIGEN void
apply_block_householder_on_the_left<Block<MatrixXd>, Block<MatrixXd>, VectorBlock<const VectorXd>>(
    Block<MatrixXd>&, const Block<MatrixXd>&, const VectorBlock<const VectorXd>&, bool);
INSTANCE_OF_EIGEN void make_block_householder_triangular_factor<Matrix<double, Dynamic, Dynamic, RowMajor>,
                                                                Block<MatrixXd>, VectorBlock<const VectorXd>>(
    Matrix<double, Dynamic, Dynamic, RowMajor>&, const Block<MatrixXd>&, const VectorBlock<const VectorXd>&);
INSTANCE_OF_EIGEN void make_block_householder_triangular_factor<
    Matrix<double, Dynamic, Dynamic, RowMajor>, Block<MatrixXd>, Block<const VectorXd, Dynamic, 1>>(
    Matrix<double, Dynamic, Dynamic, RowMajor>&, const Block<MatrixXd>&,
    const Block<const VectorXd, Dynamic, 1>&);

using InstanceKernel = gebp_traits<double, double>;
using InstanceResult = blas_data_mapper<double, Index, ColMajor>;
using InstanceColumns = const_blas_data_mapper<double, Index, ColMajor>;
using InstanceRows = const_blas_data_mapper<double, Index, RowMajor>;

INSTANCE_OF_EIGEN struct gebp_kernel<double, double, Index, InstanceResult, InstanceKernel::mr,
                                     InstanceKernel::nr, false, false>;
INSTANCE_OF_EIGEN struct gemm_pack_lhs<double, Index, InstanceColumns, InstanceKernel::mr,
                                       InstanceKernel::LhsProgress, InstanceKernel::LhsPacket4Packing,
                                       ColMajor>;
INSTANCE_OF_EIGEN struct gemm_pack_lhs<double, Index, InstanceRows, InstanceKernel::mr,
                                       InstanceKernel::LhsProgress, InstanceKernel::LhsPacket4Packing,
                                       RowMajor>;
INSTANCE_OF_EIGEN struct gemm_pack_rhs<double, Index, InstanceColumns, InstanceKernel::nr, ColMajor>;
INSTANCE_OF_EIGEN struct gemm_pack_rhs<double, Index, InstanceRows, InstanceKernel::nr, RowMajor>;
INSTANCE_OF_EIGEN struct gemm_pack_rhs<double, Index, InstanceResult, InstanceKernel::nr, ColMajor, false,
                                       true>;
INSTANCE_OF_EIGEN struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor,
                                                       false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor,
                                                       false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor,
                                                       false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct general_matrix_matrix_product<Index, double, RowMajor, false, double, RowMajor,
                                                       false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct general_matrix_vector_product<Index, double, InstanceColumns, ColMajor, false,
                                                       double, InstanceColumns, false>;
INSTANCE_OF_EIGEN struct general_matrix_vector_product<Index, double, InstanceColumns, ColMajor, false,
                                                       double, InstanceRows, false>;
INSTANCE_OF_EIGEN struct general_matrix_vector_product<Index, double, InstanceRows, RowMajor, false, double,
                                                       InstanceColumns, false>;
INSTANCE_OF_EIGEN struct general_matrix_vector_product<Index, double, InstanceRows, RowMajor, false, double,
                                                       InstanceRows, false, 1>;
INSTANCE_OF_EIGEN struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor,
                                                 1>;
INSTANCE_OF_EIGEN struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor,
                                                 ColMajor, 1>;
INSTANCE_OF_EIGEN struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor,
                                                 1>;
INSTANCE_OF_EIGEN struct triangular_solve_vector<double, double, Index, OnTheLeft, UnitLower, false,
                                                 ColMajor>;
INSTANCE_OF_EIGEN struct triangular_solve_vector<double, double, Index, OnTheLeft, Upper, false, ColMajor>;
INSTANCE_OF_EIGEN struct selfadjoint_matrix_vector_product<double, Index, ColMajor, Lower, false, false>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, Lower, true, RowMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, Upper, true, RowMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, Upper, true, ColMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, UnitLower, true, RowMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, UnitLower, true, ColMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct product_triangular_matrix_matrix<double, Index, UnitUpper, true, RowMajor, false,
                                                          ColMajor, false, ColMajor, 1>;
INSTANCE_OF_EIGEN struct triangular_matrix_vector_product<Index, UnitUpper, double, false, double, false,
                                                          RowMajor>;

}  // namespace internal
}  // namespace Eigen

#undef INSTANCE_OF_EIGEN
