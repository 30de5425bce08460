#pragma once

#include <string>
#include <vector>

#include "windlass/precision/study.hpp"

namespace windlass::precision {

/// The two opinions agree where they differ by no more than this, relative.
inline constexpr double agreed_R_tot = 3e-4, agreed_self_force = 1e-2;

/// One state of a thick rod, by the chain and by the discrete rod (discrete_rod/thick_minimiser.hpp). The two
/// share no code, and the discrete rod starts from nothing.
struct Opinion {
  double tension = 0.0, radius = 0.0;  ///< T [EI/ρ²], r [ρ]
  std::string topology;                ///< what the chain says touches
  struct Value {
    double R_tot = 0.0, self_force = 0.0;  ///< [EI/ρ²]
    double seconds = 0.0;                  ///< of the processor
  };
  Value chain, discrete;
  /// Of the discrete rod from the chain, relative (to R_tot where there is no force between strands).
  double R_tot_difference = 0.0, self_force_difference = 0.0;
  struct Mesh {
    double h = 0.0;  ///< length of elements near the coil [ρ]
    int unknowns = 0, iterations = 0;
    double R_tot = 0.0, self_force = 0.0;
  };
  std::vector<Mesh> meshes;  ///< coarsest first; `discrete` is their limit

  bool agrees() const;
};

struct SecondOpinion {
  double angle = 0.0, length = 0.0;  ///< of the scene
  std::vector<Opinion> states;
  std::vector<std::string> failures;  ///< "T = .., R/r = ..: reason"
};

struct OpinionStates {
  std::vector<double> tensions, radii;  ///< every pair of them; empty: see default_states

  bool empty() const { return tensions.empty() && radii.empty(); }
};

/// R/r = 1, 2.5, 5 and T = 1 .. 12: strands apart, touching, touching twice, on the cylinder. Two turns and
/// more to T = 4: strands that lie on each other along lines are not modelled by the chain.
OpinionStates default_states(const scene::Scene& scene);

/// Can the discrete rod do the scene? A thick, isotropic, naturally straight rod, its ends free of moment.
bool has_second_opinion(const scene::Scene& scene);

/// Where one of the two lists of states is empty the scene's own value stands for it.
SecondOpinion second_opinion(const scene::Scene& scene, OpinionStates states, const StudyOptions& options);

/// A line a state, each mesh's values last.
std::string to_csv(const SecondOpinion& opinion);

/// For people: the same in columns, and what it comes to.
std::string to_text(const SecondOpinion& opinion);

}  // namespace windlass::precision
