#include "symmetric_factors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

// LAPACK reaches the program through PETSc.
extern "C" {
void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* pivot, double* work,
             const int* work_size, int* info);
void dsytrs_(const char* uplo, const int* n, const int* columns, const double* a, const int* lda,
             const int* pivot, double* b, const int* ldb, int* info);
}

namespace windlass::chain {

SymmetricFactors::SymmetricFactors(Eigen::MatrixXd a) : factors_(std::move(a)), pivot_(factors_.rows()) {
  int n = static_cast<int>(factors_.rows()), info = 0, work_size = 64 * std::max(n, 1);
  if (n == 0) return;
  const double rounding = std::numeric_limits<double>::epsilon() * factors_.cwiseAbs().maxCoeff();
  Eigen::VectorXd work(work_size);
  dsytrf_("L", &n, factors_.data(), &n, pivot_.data(), work.data(), &work_size, &info);
  for (int k = 0; k < n; ++k) {
    if (pivot_[k] > 0) {
      if (factors_(k, k) == 0.0) factors_(k, k) = rounding;
      negative_ += factors_(k, k) < 0.0;
    } else {  // a 2×2 pivot has one eigenvalue of each sign
      ++negative_;
      ++k;
    }
  }
}

double SymmetricFactors::least_pivot() const {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < factors_.rows(); ++k) {
    double size = std::abs(factors_(k, k));
    if (pivot_[k] <= 0) {
      size = std::sqrt(
          std::abs(factors_(k, k) * factors_(k + 1, k + 1) - factors_(k + 1, k) * factors_(k + 1, k)));
      ++k;
    }
    least = std::min(least, size);
  }
  return least;
}

void SymmetricFactors::solve(Eigen::VectorXd& rhs) const {
  assert(rhs.size() == factors_.rows());
  const int n = static_cast<int>(factors_.rows()), one = 1;
  if (n == 0) return;
  int info = 0;
  dsytrs_("L", &n, &one, factors_.data(), &n, pivot_.data(), rhs.data(), &n, &info);
}

}  // namespace windlass::chain
