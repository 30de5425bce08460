#pragma once

#include "dense_spectrum.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::stability {

/// SLEPc's solver for large second variations; see SpectrumSolver.
class SparseSpectrum {
 public:
  SparseSpectrum();
  EigenPairs solve(const chain::Chain::SecondVariation& variation, int count);

 private:
  /// Factors K − σM and returns its negative pivots; retreats from a σ at which that is singular.
  int factor(const chain::Chain::SecondVariation& variation);
  int negative_pivots() const;
  EigenPairs solve_for(int wanted);

  petsc::EpsHandle eps_;
  petsc::MatHandle matrix_, metric_;
  double shift_ = 0.0;
};

}  // namespace windlass::stability
