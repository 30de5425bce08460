#pragma once

#include <array>
#include <memory>
#include <vector>

#include "dense_spectrum.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::stability {

/// SLEPc's solver for second variations of one sparsity pattern. Along a branch only numbers change: the matrices are
/// kept, so that MUMPS makes its symbolic factorisation once.
class PatternSpectrum {
 public:
  PatternSpectrum();
  /// Has the pattern of the last one.
  bool fits(const chain::Chain::SecondVariation& variation) const;
  EigenPairs solve(const chain::Chain::SecondVariation& variation, int count);

 private:
  /// Factors K − σM and returns its negative pivots; retreats from a σ at which that is singular.
  int factor(const chain::Chain::SecondVariation& variation);
  int negative_pivots() const;
  EigenPairs solve_for(int wanted);

  petsc::EpsHandle eps_;
  petsc::MatHandle matrix_, metric_;
  std::vector<int> pattern_;
  double shift_ = 0.0;
};

/// Solver for large second variations; see SpectrumSolver. Keeps the two last patterns: a half chain is asked for even
/// and odd variations in turn.
class SparseSpectrum {
 public:
  EigenPairs solve(const chain::Chain::SecondVariation& variation, int count);

 private:
  std::array<std::unique_ptr<PatternSpectrum>, 2> solvers_;
  std::size_t next_ = 0;  ///< the one to be replaced
};

}  // namespace windlass::stability
