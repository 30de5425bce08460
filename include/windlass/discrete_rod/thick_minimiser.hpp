#pragma once

#include <functional>
#include <vector>

#include "windlass/discrete_rod/thick_energy.hpp"

/// A second opinion on rods with a thickness, which shares no code with chain and contact.
namespace windlass::discrete_rod {

/// A rod round the cylinder, or round nothing, its ends free of moment under pulls T (±cos(φ/2), sin(φ/2), 0); dimensionless.
/// Without a cylinder φ = 0, and the unit of length is to be √(B/T) or so, that of the rod's loops.
struct ThickRod {
  double tension = 1.0, angle = 0.0;
  double half_length = 0.0;
  double radius = 0.0;  ///< r [ρ]
  /// Corners of the curve it starts on, the half s >= 0 from the mid-point on, straight on beyond the last; empty: a helix.
  std::vector<SplineRod::Point> curve = {};
  double fine_length = 0.0;  ///< of fine elements, from the mid-point on [ρ]; 0: as the angle asks for
  bool cylinder = true;      ///< else the rod is knotted round itself

  /// @throws std::invalid_argument naming the bound violated
  void validate() const;
  /// Half the rod as far as strands of a knot touch: loops are some times sqrt(B/T) wide.
  double length_of_knot() const;
  /// Its centre line with elements of length h near the coil.
  SplineRod spline(double h) const;
};

/// Minimum of `ThickEnergy` on one mesh.
struct ThickMinimum {
  bool converged = false;  ///< to a minimum: the Hessian is positive definite
  bool open = false;       ///< at rest without a touch: the pulls have drawn it straight
  double h = 0.0;          ///< length of the elements near the coil [ρ]
  int unknowns = 0, iterations = 0;
  double R_tot = 0.0, self_force = 0.0;  ///< of the whole rod [EI/ρ²]
  double energy = 0.0;                   ///< of bending, whole rod [EI/ρ]
  SplineRod::Vector x;
  ThickPenalties penalties;
};

/// Minimises `ThickEnergy` over the curves that are their own half-turn image, by TAO: Newton in a trust
/// region (TAONTR), whose conjugate gradients are preconditioned by the factors of the Hessian, shifted where
/// it is not positive definite. From soft to stiff, then the multipliers of lengths and of the closest
/// approach: elements keep their lengths and strands their distance exactly. What is left is O(h³) of the
/// cylinder's bed, whose stiffness κ follows the mesh, (4 EI/κ)^¼ = 3/2 h, and O(h²) of the length over which
/// strands push.
///
/// @param start  a minimum on another mesh; none: a helix laid on the closed form of the thin flat coil
/// @throws std::invalid_argument for rods or h out of bounds; petsc::Error if PETSc fails
/// PETSc options have the prefix `thick_rod_`, e.g. -thick_rod_tao_monitor.
ThickMinimum minimise(const ThickRod& rod, double h, const ThickMinimum* start = nullptr);

/// Minima on several meshes and their limit.
struct ThickLimit {
  bool converged = false;
  double R_tot = 0.0, self_force = 0.0;  ///< at h = 0
  std::vector<ThickMinimum> meshes;      ///< coarsest first
};

/// The value at h = 0 of v(h) = v + a h^order, by least squares. Two values at least.
double extrapolated(const std::vector<double>& h, const std::vector<double>& values, int order);

/// R_tot extrapolated with order 3, the force between strands with order 2, from the three finest of
/// `meshes`; the coarsest starts from nothing, each other from the one before, or from nothing where that
/// fails.
ThickLimit minimise(const ThickRod& rod, const std::vector<double>& meshes);

}  // namespace windlass::discrete_rod
