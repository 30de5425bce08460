#pragma once

#include <Eigen/Core>

#include "windlass/chain/chain.hpp"

namespace windlass::stability {

/// Finite eigenpairs as a solver finds them, in any order and of any length.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  double shift = 0.0;     ///< where the inertia was taken: zero, or slightly below where K is singular
  int inertia_index = 0;  ///< number of eigenvalues below the shift, by Sylvester's law
};

/// All finite eigenpairs of a second variation: with M = W Wᵀ of full column rank, Wᵀ K⁻¹ W y = y/μ and v = μ K⁻¹ W y.
EigenPairs dense_spectrum(const chain::Chain::SecondVariation& variation);

}  // namespace windlass::stability
