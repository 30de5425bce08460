#include "windlass/stability/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "dense_spectrum.hpp"
#include "sparse_spectrum.hpp"

namespace windlass::stability {

using chain::Chain;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

/// Eigenvalues of neutral motions are zero to rounding [EI/ρ]: they do not count as negative.
constexpr double neutral = 1e-11;

double largest_row_sum(const Sparse& matrix) {
  VectorXd sums = VectorXd::Zero(matrix.rows());
  for (Index k = 0; k < matrix.outerSize(); ++k)
    for (Sparse::InnerIterator entry(matrix, k); entry; ++entry) sums(entry.row()) += std::abs(entry.value());
  return sums.size() > 0 ? sums.maxCoeff() : 0.0;
}

/// Sorts the pairs, normalises the vectors and drops pairs above those wanted, but never a negative one.
Spectrum ordered(const Chain::SecondVariation& variation, const EigenPairs& pairs, int count) {
  std::vector<Index> order(pairs.values.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return pairs.values(a) < pairs.values(b); });
  const Index negative = (pairs.values.array() < std::min(pairs.shift, -neutral)).count();
  const Index kept = std::min<Index>(order.size(), std::max<Index>(count, negative));
  Spectrum out;
  out.index = static_cast<int>(negative);
  out.inertia_index = pairs.inertia_index;
  out.eigenvalues.resize(kept);
  out.eigenvectors.resize(variation.matrix.rows(), kept);
  const double size = largest_row_sum(variation.matrix);
  for (Index k = 0; k < kept; ++k) {
    VectorXd v = pairs.vectors.col(order[k]);
    v /= std::sqrt(v.dot(variation.metric * v));
    Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v(largest) < 0.0) v = -v;
    const double mu = pairs.values(order[k]);
    const VectorXd defect = variation.matrix * v - mu * (variation.metric * v);
    out.residual = std::max(out.residual, defect.cwiseAbs().maxCoeff() / (size * v(largest)));
    out.eigenvalues(k) = mu;
    out.eigenvectors.col(k) = v;
  }
  return out;
}

}  // namespace

SpectrumSolver::SpectrumSolver() = default;
SpectrumSolver::~SpectrumSolver() = default;
SpectrumSolver::SpectrumSolver(SpectrumSolver&&) noexcept = default;
SpectrumSolver& SpectrumSolver::operator=(SpectrumSolver&&) noexcept = default;

Spectrum SpectrumSolver::lowest(const Chain::SecondVariation& variation, int count) {
  const Index n = variation.matrix.rows();
  if (count < 1) throw std::invalid_argument("spectrum: count must be >= 1");
  if (variation.matrix.cols() != n || variation.metric.rows() != n || variation.metric.cols() != n)
    throw std::invalid_argument("spectrum: matrix and metric must be square and of one size");
  if (n <= dense_limit) return ordered(variation, dense_spectrum(variation), count);
  if (!sparse_) sparse_ = std::make_unique<SparseSpectrum>();
  try {
    return ordered(variation, sparse_->solve(variation, count), count);
  } catch (...) {
    sparse_.reset();  // SLEPc's objects may be left locked in the middle of a solve
    throw;
  }
}

Spectrum lowest(const Chain::SecondVariation& variation, int count) {
  return SpectrumSolver().lowest(variation, count);
}

}  // namespace windlass::stability
