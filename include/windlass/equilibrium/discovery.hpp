#pragma once

#include <vector>

#include "windlass/contact/joint.hpp"

/// Which parts of a planar rod touch the cylinder, from a cold start.
namespace windlass::equilibrium {

struct DiscoveryOptions {
  int elements = 80;        ///< on the half rod s >= 0
  bool clamped = false;     ///< end tangent along the pull; otherwise the end is free of moment
  int max_iterations = 40;  ///< of SNES at each pull

  /// @throws std::invalid_argument naming the bound violated
  void validate() const;
};

/// One contact of the half rod s >= 0. A line has three touching nodes or more on the whole rod, a touch one or two.
struct NodalContact {
  enum class Kind { line, touch };
  Kind kind = Kind::touch;
  double s_begin = 0.0, s_end = 0.0;          ///< equal for a touch: where its force acts [ρ]
  double angle_begin = 0.0, angle_end = 0.0;  ///< unrolled place round the axis, 0 at the south pole [rad]
  double force = 0.0;  ///< at s >= 0 only: half of the force of a contact across s = 0 [EI/ρ²]
};

/// State at the nodes of the half rod, s >= 0.
struct Discovery {
  bool converged = false;
  double R_tot = 0.0;  ///< sum of all contact forces of the whole rod [EI/ρ²]
  std::vector<double> s, theta, x, y;
  std::vector<double> gap;             ///< √(x² + y²) − 1
  std::vector<double> force;           ///< nodal contact forces; at s = 0 half of it
  std::vector<NodalContact> contacts;  ///< by increasing s
};

/// Finds the contact topology of a planar rod that is symmetric about its mid-point.
///
/// A rod of linear elements in θ with nodal contact forces λ minimises
///
///     Σ ½ h (Δθ/h)² − T·r_N   under   r_{k+1} − r_k = ∫ (cos θ, sin θ) ds,   |r_k| − 1 >= 0,
///
/// a mixed complementarity problem that PETSc's SNESVI solves: 0 <= λ_k ⊥ |r_k| − 1 >= 0, everything else free. The
/// integral is taken by two Gauss points, so an element on the circle has the exact chord. It starts from the closed
/// form of infinite tails where that has a line contact, at the wanted pull or a stronger one, and follows the state
/// down: below the limit of line contact other states solve the problem too, with the rod past the cylinder.
///
/// The topology is right, R_tot good to a few 1e-4 with 80 elements; precision is the arcs' business. Solves in the
/// plane: the rod may cross itself. A rod that has lost all contact (no stretches) may be shifted freely.
///
/// @param loads  tension > 0, angle > 0 and half_length > angle/2 are read
/// @return       converged = false if the state was lost on the way down; the rest is then empty
/// @throws std::invalid_argument for loads or options out of bounds; petsc::Error if PETSc fails otherwise
/// PETSc options have the prefix `discovery_`, e.g. -discovery_snes_monitor.
Discovery discover_contacts(const contact::Loads& loads, const DiscoveryOptions& options = {});

}  // namespace windlass::equilibrium
