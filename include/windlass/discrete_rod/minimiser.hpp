#pragma once

#include "windlass/contact/joint.hpp"

/// A plain discrete elastic rod, kept for comparison: what one writes first, and what the arcs are measured against.
namespace windlass::discrete_rod {

struct MinimiserOptions {
  int edges = 80;           ///< of equal length, on the half rod s >= 0
  bool clamped = false;     ///< last edge along the pull; otherwise the end is free of moment
  double stretching = 1e6;  ///< EA [EI/ρ²]
  double penalty = 0.0;  ///< κ, contact force per penetration and length [EI/ρ⁴]; 0: 4/h⁴, see minimise

  /// @throws std::invalid_argument naming the bound violated
  void validate() const;
};

struct Minimum {
  bool converged = false;  ///< to a minimum that touches the cylinder
  int unknowns = 0, iterations = 0;
  double R_tot = 0.0;     ///< sum of the penalty forces of the whole rod [EI/ρ²]
  double phi_star = 0.0;  ///< place of the last penetrating node [rad]
  double energy = 0.0;    ///< of bending, whole rod [EI/ρ]
};

/// Minimises the energy of a planar half rod, symmetric about s = 0, over the places of its nodes:
///
///     E = Σ_e ½ EA h (|e|/h − 1)² + Σ_k ½ (Δα_k)²/h + Σ_k ½ κ h max(0, 1 − |x_k|)² − T·x_N,
///
/// α the direction of an edge, h its length at rest (M. Bergou et al., Discrete Elastic Rods, 2008, in the plane). PETSc's
/// TAO does it: Newton with line search (TAONLS), exact sparse Hessian, LU. Stiffnesses rise in steps to those asked for,
/// from the closed form of infinite tails laid on the nodes. Errors: O(h²) of the rod, O(T/EA) and O(p/κ) of the
/// softness. A point force is smeared over the (4 EI/κ)^¼ of a beam on an elastic bed: over an edge, with κ = 4/h⁴.
///
/// @param loads  tension > 1/2, angle > 0 and half_length > angle/2 are read
/// @throws std::invalid_argument for loads or options out of bounds; petsc::Error if PETSc fails
/// PETSc options have the prefix `discrete_rod_`, e.g. -discrete_rod_tao_monitor.
Minimum minimise(const contact::Loads& loads, const MinimiserOptions& options = {});

}  // namespace windlass::discrete_rod
