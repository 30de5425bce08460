#pragma once

#include <array>
#include <memory>

#include "dense_spectrum.hpp"
#include "windlass/chain/variation.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::stability {

/// SLEPc's Krylov-Schur for Wᵀ K⁻¹ W y = y/μ (chain::Variation), in a shell matrix. SLEPc's objects stay as long as the
/// number of points does: along a branch, until the mesh changes.
class KrylovSpectrum {
 public:
  explicit KrylovSpectrum(Eigen::Index points);
  Eigen::Index points() const { return points_; }

  /// The pairs nearest to zero: all negative ones and the positive ones nearest to zero, `count` or more in all, or all
  /// there are.
  /// @param zero  as small as this, an eigenvalue may be one that the inertia counts as negative
  EigenPairs solve(const chain::Variation& variation, int count, double zero);

 private:
  static PetscErrorCode apply(Mat shell, Vec in, Vec out);
  petsc::EpsHandle solver() const;
  /// The `wanted` largest |1/μ| without those already found, whose vectors y are given; appends. False: there are no more.
  bool find(int wanted, std::vector<double>& found, std::vector<petsc::VecHandle>& vectors);

  Eigen::Index points_;
  petsc::EpsHandle eps_;
  petsc::MatHandle operator_;
  const chain::Variation* variation_ = nullptr;
  Eigen::VectorXd in_;
};

/// Solvers of the last two sizes: a half chain is asked for even and odd variations in turn.
class KrylovSpectra {
 public:
  KrylovSpectrum& of(Eigen::Index points);

 private:
  std::array<std::unique_ptr<KrylovSpectrum>, 2> solvers_;
  std::size_t next_ = 0;  ///< the one to be replaced
};

}  // namespace windlass::stability
