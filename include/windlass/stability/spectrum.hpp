#pragma once

#include <Eigen/Core>
#include <memory>

#include "windlass/chain/chain.hpp"

/// Lowest eigenvalues of the second variation, through SLEPc, with the index confirmed by inertia.
namespace windlass::stability {

/// Finite eigenpairs K v = μ M v of a second variation, K indefinite (multipliers), M positive semidefinite.
struct Spectrum {
  Eigen::VectorXd eigenvalues;   ///< μ ascending; at least the asked number, or all there are [EI/ρ²]
  Eigen::MatrixXd eigenvectors;  ///< one column each, vᵀMv = 1, largest entry positive; size of K × count
  int index = 0;                 ///< negative eigenvalues found; zero to rounding counts as positive
  int inertia_index = 0;         ///< the same from the inertia of K: its negative pivots less `constraints`
  double residual = 0.0;         ///< max ‖K v − μ M v‖∞ / ‖K‖∞‖v‖∞ over the pairs
  bool agrees() const { return index == inertia_index; }
};

class SparseSpectrum;

/// Krylov-Schur with shift-and-invert at zero shift: K⁻¹M v = v/μ, K = LDLᵀ by MUMPS.
///
/// Sylvester's law gives the number of negative μ from the same factorisation, K's negative pivots less the
/// `constraints` that multipliers and touch locations own. Pairs come in order of |μ|, so as many are asked for as
/// are wanted plus the negative ones, and more until every negative one is there. Where K is singular to rounding
/// (at a bifurcation) the shift moves slightly below zero, and the inertia counts the μ below it.
///
/// Small problems (up to `dense_limit` unknowns) use a dense solver: with M = W Wᵀ of full column rank,
/// Wᵀ K⁻¹ W y = y/μ is an ordinary symmetric problem and v = μ K⁻¹ W y.
///
/// Reusable along a branch: SLEPc's objects are kept, sizes and patterns may change. SLEPc's options apply, without
/// prefix (-eps_tol, -eps_monitor, -st_ksp_view ...).
class SpectrumSolver {
 public:
  static constexpr int dense_limit = 24;

  SpectrumSolver();
  ~SpectrumSolver();
  SpectrumSolver(SpectrumSolver&&) noexcept;
  SpectrumSolver& operator=(SpectrumSolver&&) noexcept;

  /// @param count  how many of the lowest eigenvalues are wanted, >= 1; all negative ones are returned in any case
  /// @throws std::invalid_argument if count < 1 or the matrices do not fit each other; petsc::Error if MUMPS or
  ///         SLEPc fails; std::runtime_error if the eigenvalues asked for did not converge
  Spectrum lowest(const chain::Chain::SecondVariation& variation, int count);

 private:
  std::unique_ptr<SparseSpectrum> sparse_;
};

/// One spectrum, with a solver of its own. Parameters and errors as SpectrumSolver::lowest.
Spectrum lowest(const chain::Chain::SecondVariation& variation, int count);

}  // namespace windlass::stability
