#include "continuation/sparse_problem.hpp"

#include <Eigen/SparseCholesky>
#include <stdexcept>
#include <utility>
#include <vector>

#include "continuation/eigen_sparse_instances.hpp"

namespace continuation {

struct SparseProblem::Factors {
  Eigen::SparseLU<Sparse> lu;
  Eigen::SimplicialLDLT<Sparse> ldlt;
};

SparseProblem::SparseProblem(Eigen::Index n, Residual residual, Jacobian jacobian, bool symmetric)
    : n_(n),
      residual_(std::move(residual)),
      jacobian_(std::move(jacobian)),
      symmetric_(symmetric),
      factors_(std::make_unique<Factors>()) {}

SparseProblem::~SparseProblem() = default;

SparseProblem::SparseProblem(const SparseProblem& other)
    : SparseProblem(other.n_, other.residual_, other.jacobian_, other.symmetric_) {}

void SparseProblem::factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C,
                           const Matrix& D) {
  const Eigen::Index k = B.cols();
  j_ = jacobian_(x, p);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(j_.nonZeros() + 2 * k * n_ + k * k));
  for (Eigen::Index c = 0; c < j_.outerSize(); ++c)
    for (Sparse::InnerIterator entry(j_, c); entry; ++entry)
      entries.emplace_back(entry.row(), entry.col(), entry.value());
  for (Eigen::Index c = 0; c < k; ++c) {
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (B(i, c) != 0.0) entries.emplace_back(i, n_ + c, B(i, c));
      if (C(i, c) != 0.0) entries.emplace_back(n_ + c, i, C(i, c));
    }
    for (Eigen::Index i = 0; i < k; ++i) entries.emplace_back(n_ + i, n_ + c, D(i, c));
  }
  Sparse m(n_ + k, n_ + k);
  m.setFromTriplets(entries.begin(), entries.end());
  factors_->lu.compute(m);
  if (factors_->lu.info() != Eigen::Success) throw std::runtime_error("the bordered matrix is singular");
}

Vector SparseProblem::solve(const Vector& f, const Vector& g) {
  Vector r(f.size() + g.size());
  r << f, g;
  return factors_->lu.solve(r);
}

Vector SparseProblem::solve_transposed(const Vector& f, const Vector& g) {
  Vector r(f.size() + g.size());
  r << f, g;
  return factors_->lu.transpose().solve(r);
}

int SparseProblem::index(const Vector&, const Vector&) {
  if (!symmetric_) return -1;
  factors_->ldlt.compute(j_);
  if (factors_->ldlt.info() != Eigen::Success) return -1;
  return static_cast<int>((factors_->ldlt.vectorD().array() < 0.0).count());
}

int SparseProblem::determinant_sign() { return factors_->lu.signDeterminant() < 0.0 ? -1 : 1; }

}  // namespace continuation
