#pragma once

#include <Eigen/Core>

/// A rod pulled from rest: incremental Coulomb friction on the discrete rod, step by step in the displacement.
namespace windlass::pull {

/// Coulomb's law at one place, with a short elastic slip in place of none: the traction is
///
///     q = −mu p φ(|g|/δ) g/|g|,   φ(x) = 1 − [1 − x]₊, its corner rounded (`rounded`) over 1 ± w,
///
/// g the slip of the rod against the cylinder that has not been forgotten. A step adds its own slip, and what lies beyond
/// (1 + w) δ is forgotten (return to the cone, PHYSICS, "Pull from rest"). So |q| <= mu p
/// always, |q| = mu p while the place slips, and q opposes the slip once that is long against δ.
struct Coulomb {
  double friction = 0.0;  ///< mu
  double slip = 1e-3;     ///< δ [ρ]

  struct Traction {
    Eigen::Vector2d by_pressure;  ///< q/p
    Eigen::Matrix2d by_slip;      ///< ∂q/∂g over p [1/ρ]
    bool sticks = true;           ///< inside the cone
  };
  /// @param g  slip with that of the step (round, along the axis) [ρ]
  Traction operator()(const Eigen::Vector2d& g) const;
  /// What is remembered of g.
  Eigen::Vector2d kept(const Eigen::Vector2d& g) const;

 private:
  static constexpr double corner = 0.5;  ///< w
};

}  // namespace windlass::pull
