#pragma once

#include <Eigen/Core>
#include <memory>

#include "windlass/chain/variation.hpp"

/// Lowest eigenvalues of the second variation, through SLEPc, with the index confirmed by inertia.
namespace windlass::stability {

/// Finite eigenpairs K v = μ M v of a second variation, K indefinite (multipliers), M positive semidefinite.
struct Spectrum {
  Eigen::VectorXd eigenvalues;   ///< μ ascending; at least the asked number, or all there are [EI/ρ²]
  Eigen::MatrixXd eigenvectors;  ///< one column each, vᵀMv = 1, largest entry positive; size of K × count
  int index = 0;                 ///< negative eigenvalues found; zero to rounding counts as positive
  int inertia_index = 0;  ///< the same from the inertia of K: its negative pivots less the constraints'
  bool rounded = false;   ///< one is zero to rounding: its sign means nothing
  bool agrees() const { return index == inertia_index; }
};

class KrylovSpectra;

/// Krylov-Schur on Wᵀ K⁻¹ W y = y/μ, K⁻¹ by the chain's own factors (chain::Variation): shift-and-invert at zero shift, as
/// an ordinary symmetric problem.
///
/// Sylvester's law gives the number of negative μ from the same factors. Pairs come in order of |μ|, so as many are asked
/// for as are wanted plus the negative ones, and more until every negative one is there. Where K is singular (at a
/// bifurcation) the largest 1/μ would hide the others in its rounding; it is then found alone and taken out of the rest.
///
/// Reusable along a branch: SLEPc's objects are kept, sizes may change. SLEPc's options apply, without prefix (-eps_tol,
/// -eps_monitor ...).
class SpectrumSolver {
 public:
  SpectrumSolver();
  ~SpectrumSolver();
  SpectrumSolver(SpectrumSolver&&) noexcept;
  SpectrumSolver& operator=(SpectrumSolver&&) noexcept;

  /// @param count  how many of the lowest eigenvalues are wanted, >= 1; all negative ones are returned in any case
  /// @throws std::invalid_argument if count < 1; petsc::Error if SLEPc fails; std::runtime_error if the eigenvalues asked
  ///         for did not converge
  Spectrum lowest(const chain::Variation& variation, int count);

 private:
  std::unique_ptr<KrylovSpectra> solvers_;
};

/// All finite eigenvalues of a small second variation, from its assembled matrices and by LAPACK: the second opinion of
/// the tests. Its work grows with the cube of the size.
/// @throws std::invalid_argument if the matrices do not fit each other
Spectrum all(const chain::Chain::SecondVariation& variation);

}  // namespace windlass::stability
