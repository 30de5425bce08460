#pragma once

#include <array>
#include <memory>
#include <vector>

#include "windlass/chain/variation.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::stability {

/// What the error that Newton's method has left makes of the zero of a neutral turn [EI/ρ²].
inline constexpr double neutral_turn = 3e-9;

/// An eigenpair of Wᵀ K⁻¹ W y = θ y, and of K v = μ M v.
struct Pair {
  Eigen::VectorXd y, v;
  double theta = 0.0;
  double value = 0.0, rounding = 0.0;  ///< μ by Variation::quotient
};

/// SLEPc's Krylov-Schur for the operator of a chain::Variation. Its objects stay as long as the number of points does: along
/// a branch, until the mesh changes.
class KrylovSpectrum {
 public:
  explicit KrylovSpectrum(Eigen::Index points);
  Eigen::Index points() const { return points_; }

  /// All negative pairs and the positive ones nearest to zero, `count` or more in all, or all there are; in any order.
  std::vector<Pair> solve(const chain::Variation& variation, int count);

 private:
  static PetscErrorCode apply(Mat shell, Vec in, Vec out);
  /// SLEPc's callbacks for the order of the θ and for how far one is from convergence.
  static PetscErrorCode prefer_negative(PetscScalar a, PetscScalar, PetscScalar b, PetscScalar,
                                        PetscInt* result, void* context);
  static PetscErrorCode error_of(EPS, PetscScalar theta, PetscScalar, PetscReal residual, PetscReal* error,
                                 void* context);
  /// Appends the `wanted` extreme θ among those not found so far. False: all that is left is rounding.
  bool find(EPSWhich which, int wanted);
  void find_negative(int index);
  void find_nearest(int count);
  void refine();
  Eigen::VectorXd start();
  /// Pairs that are, or may be, those that the inertia counts as negative.
  int negative() const;
  void project_out(Eigen::Ref<Eigen::VectorXd> y) const;
  Pair pair(Eigen::VectorXd y, double theta) const;
  int left() const { return static_cast<int>(points_) - static_cast<int>(found_.size()); }

  Eigen::Index points_;
  petsc::EpsHandle eps_;
  petsc::MatHandle operator_;
  petsc::VecHandle vector_;
  const chain::Variation* variation_ = nullptr;
  std::vector<Pair> found_;
  double scale_ = 0.0;  ///< largest |θ| met in the search
  int failed_ = 0;      ///< searches for negative θ
  unsigned starts_ = 0;
  EPSWhich which_ = EPS_ALL;  ///< what SLEPc is set up for
  int wanted_ = 0, most_ = 0;
};

/// Keeps the solvers of the two last sizes: a half chain is asked for even and odd variations in turn.
class KrylovSpectra {
 public:
  KrylovSpectrum& of(Eigen::Index points);

 private:
  std::array<std::unique_ptr<KrylovSpectrum>, 2> solvers_;
  std::size_t next_ = 0;  ///< the one to be replaced
};

}  // namespace windlass::stability
