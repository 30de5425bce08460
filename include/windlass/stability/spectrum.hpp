#pragma once

#include <Eigen/Core>
#include <memory>

#include "windlass/chain/variation.hpp"

/// Lowest eigenvalues of the second variation, through SLEPc, with the index confirmed by inertia.
namespace windlass::stability {

/// Finite eigenpairs K v = μ M v of a second variation, K indefinite (multipliers), M positive semidefinite.
struct Spectrum {
  Eigen::VectorXd eigenvalues;  ///< μ ascending; at least the asked number, or all there are [EI/ρ²]
  Eigen::VectorXd rounding;     ///< what rounding may have made of each [EI/ρ²]
  Eigen::MatrixXd
      eigenvectors;       ///< one column each, vᵀMv = 1, largest entry positive; Variation::size() × count
  int index = 0;          ///< negative eigenvalues found; zero to rounding counts as positive
  int inertia_index = 0;  ///< the same from the inertia of K's factors
  bool rounded =
      false;  ///< one is zero to rounding, not by symmetry: its sign, and so the index, means nothing
  bool agrees() const { return index == inertia_index; }
};

class KrylovSpectra;

/// Krylov-Schur on Wᵀ K⁻¹ W y = y/μ, K⁻¹ by the chain's own factors (chain::Variation): shift-and-invert at zero shift, as
/// an ordinary symmetric problem in a shell matrix.
///
/// Sylvester's law says how many μ are negative. They come first, in spaces that grow until all are found; then what else was
/// asked for, nearest to zero. Found ones are projected out of the next search, which starts from another
/// vector: so all copies of a multiple μ are found, and at a bifurcation the huge 1/μ does not hide the others in its
/// rounding. The value returned is the quotient vᵀKv/vᵀMv of the uncondensed K.
///
/// Reusable along a branch: SLEPc's objects are kept while the number of points is the same. SLEPc's options apply, without
/// prefix (-eps_tol, -eps_monitor ...).
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

}  // namespace windlass::stability
