#include "symmetric_factors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

// LAPACK reaches the program through PETSc.
extern "C" {
void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* pivot, double* work,
             const int* work_size, int* info);
void dsytrs_(const char* uplo, const int* n, const int* columns, const double* a, const int* lda,
             const int* pivot, double* b, const int* ldb, int* info);
void dsyevr_(const char* job, const char* range, const char* uplo, const int* n, double* a, const int* lda,
             const double* low, const double* high, const int* first, const int* last,
             const double* tolerance, int* found, double* values, double* vectors, const int* ldz,
             int* support, double* work, const int* work_size, int* iwork, const int* iwork_size, int* info);
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

namespace {

/// Those within (−bound, bound] with vectors; bound 0: all, without.
void eigenvalues(Eigen::MatrixXd a, double bound, Eigen::VectorXd& values, Eigen::MatrixXd& vectors) {
  const int n = static_cast<int>(a.rows()), none = 0;
  const bool all = bound == 0.0;
  const double low = -bound, least = 0.0;
  int found = 0, info = 0;
  values.resize(n);
  vectors.resize(n, all ? 0 : n);
  const int ldz = std::max(n, 1);
  std::vector<int> support(2 * static_cast<std::size_t>(ldz));
  const int work_size = 66 * ldz, iwork_size = 10 * ldz;
  std::vector<double> work(static_cast<std::size_t>(work_size));
  std::vector<int> iwork(static_cast<std::size_t>(iwork_size));
  dsyevr_(all ? "N" : "V", all ? "A" : "V", "L", &n, a.data(), &ldz, &low, &bound, &none, &none, &least,
          &found, values.data(), vectors.data(), &ldz, support.data(), work.data(), &work_size, iwork.data(),
          &iwork_size, &info);
  if (info != 0) throw std::domain_error("a second variation that is not finite has no eigenvalues");
  values.conservativeResize(found);
  if (!all) vectors.conservativeResize(n, found);
}

}  // namespace

SmallEigenvalues small_eigenvalues(const Eigen::MatrixXd& a, double close) {
  SmallEigenvalues out;
  if (a.rows() == 0) return out;
  // Up to here all vectors cost less than a Newton step. Signs at rounding are those of whichever way is taken.
  constexpr Eigen::Index few = 500;
  if (a.rows() <= few) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a);
    const Eigen::VectorXd& values = eigen.eigenvalues();
    const double bound = close * values.cwiseAbs().maxCoeff();
    const Eigen::Index begin = (values.array() < -bound).count(), end = (values.array() <= bound).count();
    out.negative = static_cast<int>((values.array() < 0.0).count());
    out.values = values.segment(begin, end - begin);
    out.vectors = eigen.eigenvectors().middleCols(begin, end - begin);
    return out;
  }
  Eigen::VectorXd all;
  eigenvalues(a, 0.0, all, out.vectors);
  const double bound = close * all.cwiseAbs().maxCoeff();
  if ((all.array().abs() <= bound).any()) eigenvalues(a, bound, out.values, out.vectors);
  // The signs of those next to nothing are those of the values given: another way to them rounds differently.
  out.negative = static_cast<int>((all.array() < -bound).count() + (out.values.array() < 0.0).count());
  return out;
}

}  // namespace windlass::chain
