#include "windlass/stability/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "krylov_spectrum.hpp"

namespace windlass::stability {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Sorts the pairs, turns the vectors and drops pairs above those wanted, but never a negative one.
Spectrum ordered(std::vector<Pair> pairs, const chain::Variation& variation, int count) {
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.value < b.value; });
  Spectrum out;
  out.inertia_index = variation.negative();
  const auto nearest = std::min_element(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::abs(a.value) < std::abs(b.value);
  });
  for (auto pair = pairs.begin(); pair != pairs.end(); ++pair) {
    if (pair == nearest && variation.neutral() && std::abs(pair->value) < neutral_turn) continue;
    const double zero = std::max(pair->rounding, variation.neutral_size());
    out.index += pair->value < -zero;
    out.rounded |= std::abs(pair->value) <= zero;
  }
  const auto kept = std::min<Index>(static_cast<Index>(pairs.size()), std::max(count, out.index));
  out.eigenvalues.resize(kept);
  out.rounding.resize(kept);
  out.eigenvectors.resize(variation.size(), kept);
  for (Index k = 0; k < kept; ++k) {
    VectorXd v = pairs[k].v / variation.rotations(pairs[k].v).norm();
    Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v(largest) < 0.0) v = -v;
    out.eigenvalues(k) = pairs[k].value;
    out.rounding(k) = pairs[k].rounding;
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
    Spectrum out = ordered(solvers_->of(variation.points()).solve(variation, count), variation, count);
    if (out.eigenvalues.size() < std::min<Index>(count, 1))
      throw std::runtime_error("spectrum: no eigenvalue converged");
    return out;
  } catch (...) {
    solvers_.reset();  // SLEPc's objects may be left locked in the middle of a solve
    throw;
  }
}

}  // namespace windlass::stability
