#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/precision/study.hpp"

namespace windlass::precision {

/// An equilibrium at far higher resolution than any it is compared with, and what the methods start from.
struct Reference {
  scene::Scene scene;
  bool flat = false;
  chain::Topology topology;            ///< of the half chain
  std::vector<chain::ArcMesh> meshes;  ///< equidistributed; the ladders thin them
  chain::Profile guess;                ///< right half: the closed form for flat states, else the state itself
  std::vector<double> s;               ///< joints of the guess
  Quantities value;
  int unknowns = 0;
};

/// @throws equilibrium::NoEquilibrium
Reference make_reference(const scene::Scene& scene);

/// Collocation arcs on a fixed mesh.
class ArcSolver {
 public:
  /// @param stages  0: the tail is a formula
  ArcSolver(const Reference& reference, bool spatial, bool half, int elements, int stages);

  /// From the guess to a converged state and its R_tot; this is what is timed. False if Newton fails.
  bool solve();
  /// Everything else at that state.
  Quantities quantities();
  /// Where the equations of the flat state are singular, on this mesh: zero of the bordered scalar (A. Griewank and
  /// G. Reddien, SIAM J. Numer. Anal. 21, 1984) by secants from `near`; nullopt if there is none. Kirchhoff arcs only.
  std::optional<double> transition(double near);
  /// Unstable directions even under the half-turn, the state followed to another tension; −1 if Newton fails.
  int even_index(double tension);
  int unknowns() const { return problem_ ? static_cast<int>(problem_->size()) : 0; }

 private:
  /// g of  [J m; mᵀ 0] [v; g] = [0; 1]  at the state of this tension, which is held along the mode m: J may be singular.
  double singularity(double tension, const equilibrium::Vector& mode);

  const Reference& reference_;
  bool spatial_, half_;
  std::vector<chain::ArcMesh> meshes_;
  std::shared_ptr<equilibrium::RodProblem> problem_;
  equilibrium::Vector x_, p_;
};

}  // namespace windlass::precision
