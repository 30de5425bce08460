#include "windlass/stability/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "dense_spectrum.hpp"
#include "krylov_spectrum.hpp"

namespace windlass::stability {

using chain::Chain;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Rounding of an eigenvalue is that of the stiffest motion times a small number, for the sums in K⁻¹.
constexpr double sums = 16.0;

/// Sorts the pairs, turns the vectors and drops pairs above those wanted, but never a negative one.
/// @param zero  eigenvalues as small as this are neutral motions, or not to be told from them
Spectrum ordered(const EigenPairs& pairs, int count, double zero) {
  std::vector<Index> order(pairs.values.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return pairs.values(a) < pairs.values(b); });
  Spectrum out;
  out.index = static_cast<int>((pairs.values.array() < std::min(pairs.shift, -zero)).count());
  out.inertia_index = pairs.inertia_index;
  out.rounded = (pairs.values.array().abs() <= zero).any();
  const Index kept = std::min<Index>(order.size(), std::max(count, out.index));
  out.eigenvalues.resize(kept);
  out.eigenvectors.resize(pairs.vectors.rows(), kept);
  for (Index k = 0; k < kept; ++k) {
    VectorXd v = pairs.vectors.col(order[k]);
    Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v(largest) < 0.0) v = -v;
    out.eigenvalues(k) = pairs.values(order[k]);
    out.eigenvectors.col(k) = v;
  }
  return out;
}

}  // namespace

SpectrumSolver::SpectrumSolver() = default;
SpectrumSolver::~SpectrumSolver() = default;
SpectrumSolver::SpectrumSolver(SpectrumSolver&&) noexcept = default;
SpectrumSolver& SpectrumSolver::operator=(SpectrumSolver&&) noexcept = default;

Spectrum SpectrumSolver::lowest(const chain::Variation& variation, int count) {
  if (count < 1) throw std::invalid_argument("spectrum: count must be >= 1");
  if (variation.points() == 0) return {};
  if (!solvers_) solvers_ = std::make_unique<KrylovSpectra>();
  try {
    const double zero = sums * variation.rounding();
    return ordered(solvers_->of(variation.points()).solve(variation, count, zero), count, zero);
  } catch (...) {
    solvers_.reset();  // SLEPc's objects may be left locked in the middle of a solve
    throw;
  }
}

Spectrum all(const Chain::SecondVariation& variation) {
  const Index n = variation.matrix.rows();
  if (variation.matrix.cols() != n || variation.metric.rows() != n || variation.metric.cols() != n)
    throw std::invalid_argument("spectrum: matrix and metric must be square and of one size");
  constexpr double neutral = 1e-9;
  return ordered(dense_spectrum(variation), static_cast<int>(n), neutral);
}

}  // namespace windlass::stability
