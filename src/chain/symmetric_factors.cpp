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
void dsytrd_(const char* uplo, const int* n, double* a, const int* lda, double* diagonal, double* beside,
             double* tau, double* work, const int* work_size, int* info);
void dstebz_(const char* range, const char* order, const int* n, const double* low, const double* high,
             const int* first, const int* last, const double* tolerance, const double* diagonal,
             const double* beside, int* found, int* splits, double* values, int* block, int* split,
             double* work, int* iwork, int* info);
void dstein_(const int* n, const double* diagonal, const double* beside, const int* count,
             const double* values, const int* block, const int* split, double* vectors, const int* ldz,
             double* work, int* iwork, int* failed, int* info);
void dormtr_(const char* side, const char* uplo, const char* transposed, const int* rows, const int* columns,
             const double* a, const int* lda, const double* tau, double* c, const int* ldc, double* work,
             const int* work_size, int* info);
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

/// A = Q T Qᵀ with T tridiagonal: the dear part of an eigenvalue problem, done once for all that is asked of A.
class Tridiagonal {
 public:
  explicit Tridiagonal(Eigen::MatrixXd a)
      : reflectors_(std::move(a)),
        n_(static_cast<int>(reflectors_.rows())),
        diagonal_(n_),
        beside_(n_),
        tau_(n_) {
    Eigen::VectorXd work(64 * n_);
    const int work_size = static_cast<int>(work.size());
    int info = 0;
    if (!reflectors_.allFinite())
      throw std::domain_error("a second variation that is not finite has no eigenvalues");
    dsytrd_("L", &n_, reflectors_.data(), &n_, diagonal_.data(), beside_.data(), tau_.data(), work.data(),
            &work_size, &info);
    check(info);
  }

  double largest() const {
    return std::max(std::abs(within("I", 0.0, 0.0, 1, 1).values(0)),
                    std::abs(within("I", 0.0, 0.0, n_, n_).values(0)));
  }

  /// How many eigenvalues are smaller (Sturm).
  int below(double bound) const {
    constexpr double smallest = std::numeric_limits<double>::min();
    int count = 0;
    double pivot = 1.0;
    for (int k = 0; k < n_; ++k) {
      pivot = diagonal_(k) - bound - (k > 0 ? beside_(k - 1) * beside_(k - 1) / pivot : 0.0);
      if (std::abs(pivot) < smallest) pivot = -smallest;
      count += pivot < 0.0;
    }
    return count;
  }

  /// Eigenvalues in (−bound, bound] and their vectors.
  void near_zero(double bound, Eigen::VectorXd& values, Eigen::MatrixXd& vectors) const {
    const Found found = within("V", -bound, bound, 1, 1);
    const int count = static_cast<int>(found.values.size());
    values = found.values;
    vectors.resize(n_, count);
    if (count == 0) return;
    Eigen::VectorXd work(64 * n_);
    std::vector<int> iwork(n_), failed(count);
    const int work_size = static_cast<int>(work.size());
    int info = 0;
    dstein_(&n_, diagonal_.data(), beside_.data(), &count, values.data(), found.block.data(),
            found.split.data(), vectors.data(), &n_, work.data(), iwork.data(), failed.data(), &info);
    check(info);
    dormtr_("L", "L", "N", &n_, &count, reflectors_.data(), &n_, tau_.data(), vectors.data(), &n_,
            work.data(), &work_size, &info);
    check(info);
  }

 private:
  static void check(int info) {
    if (info != 0) throw std::domain_error("LAPACK found no eigenvalues of a second variation");
  }

  struct Found {
    Eigen::VectorXd values;
    std::vector<int> block, split;
  };
  Found within(const char* range, double low, double high, int first, int last) const {
    constexpr double finest = 0.0;
    Found out{Eigen::VectorXd(n_), std::vector<int>(n_), std::vector<int>(n_)};
    Eigen::VectorXd work(4 * n_);
    std::vector<int> iwork(3 * static_cast<std::size_t>(n_));
    int found = 0, splits = 0, info = 0;
    dstebz_(range, "B", &n_, &low, &high, &first, &last, &finest, diagonal_.data(), beside_.data(), &found,
            &splits, out.values.data(), out.block.data(), out.split.data(), work.data(), iwork.data(), &info);
    check(info);
    out.values.conservativeResize(found);
    return out;
  }

  Eigen::MatrixXd reflectors_;
  int n_;
  Eigen::VectorXd diagonal_, beside_, tau_;
};

}  // namespace

SmallEigenvalues small_eigenvalues(const Eigen::MatrixXd& a, double close) {
  SmallEigenvalues out;
  if (a.rows() == 0) return out;
  // Up to here all vectors cost less than a Newton step. Signs at rounding are those of whichever way is taken.
  constexpr Eigen::Index few = 250;
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
  const Tridiagonal tridiagonal(a);
  const double bound = close * tridiagonal.largest();
  tridiagonal.near_zero(bound, out.values, out.vectors);
  // The signs of those next to nothing are those of the values given: another way to them rounds differently.
  out.negative = tridiagonal.below(-bound) + static_cast<int>((out.values.array() < 0.0).count());
  return out;
}

}  // namespace windlass::chain
