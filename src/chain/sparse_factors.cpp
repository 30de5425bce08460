#include "windlass/chain/sparse_factors.hpp"

#include <umfpack.h>

#include <array>
#include <vector>

namespace windlass::chain {

struct SparseFactors::Factors {
  std::vector<int> columns, rows;  ///< of the pattern that was analysed
  void *symbolic = nullptr, *numeric = nullptr;

  Factors() = default;
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;
  ~Factors() {
    umfpack_di_free_numeric(&numeric);
    umfpack_di_free_symbolic(&symbolic);
  }

  /// Is the pattern that of before? It is kept.
  bool same_pattern(const Eigen::SparseMatrix<double>& matrix) {
    const std::vector<int> now_columns(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1),
        now_rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    const bool same = now_columns == columns && now_rows == rows;
    columns = now_columns, rows = now_rows;
    return same;
  }
};

SparseFactors::SparseFactors() : factors_(std::make_unique<Factors>()) {}
SparseFactors::~SparseFactors() = default;
SparseFactors::SparseFactors(SparseFactors&&) noexcept = default;
SparseFactors& SparseFactors::operator=(SparseFactors&&) noexcept = default;

int SparseFactors::compute() {
  // Pivots are to be off the diagonal, where multipliers have nothing: an order for those on it fills ten times as much.
  std::array<double, UMFPACK_CONTROL> control;
  umfpack_di_defaults(control.data());
  control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_UNSYMMETRIC;
  const int *column = matrix_.outerIndexPtr(), *row = matrix_.innerIndexPtr(),
            size = static_cast<int>(matrix_.rows());
  Factors& of = *factors_;
  umfpack_di_free_numeric(&of.numeric);
  if (!of.same_pattern(matrix_) || !of.symbolic) {
    umfpack_di_free_symbolic(&of.symbolic);
    if (umfpack_di_symbolic(size, size, column, row, matrix_.valuePtr(), &of.symbolic, control.data(),
                            nullptr) != UMFPACK_OK)
      return 0;
  }
  if (umfpack_di_numeric(column, row, matrix_.valuePtr(), of.symbolic, &of.numeric, control.data(),
                         nullptr) != UMFPACK_OK)
    return 0;
  double mantissa = 0.0, exponent = 0.0;
  umfpack_di_get_determinant(&mantissa, &exponent, of.numeric, nullptr);
  return (mantissa > 0.0) - (mantissa < 0.0);
}

Eigen::VectorXd SparseFactors::solve(const Eigen::VectorXd& rhs, bool transposed, bool refined) const {
  Eigen::VectorXd out(rhs.size());
  std::array<double, UMFPACK_CONTROL> control;
  umfpack_di_defaults(control.data());
  if (!refined) control[UMFPACK_IRSTEP] = 0;
  umfpack_di_solve(transposed ? UMFPACK_At : UMFPACK_A, matrix_.outerIndexPtr(), matrix_.innerIndexPtr(),
                   matrix_.valuePtr(), out.data(), rhs.data(), factors_->numeric, control.data(), nullptr);
  return out;
}

}  // namespace windlass::chain
