#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

/// The equilibria under a scene's loads, and the one that answers for them.
namespace windlass::equilibrium {

struct Started;

/// The energy to compare states under the same loads by: elastic energy plus the potential of the dead loads [EI/ρ]. Of
/// two pulls that is  T L − Σ T·r  over the two ends (T L: finite for infinite tails too, and the same for all states);
/// of a thrust P minus P times the approach of the ends; nothing where the ends are held in place.
double potential(const Solution& solution, const scene::Scene& scene);

/// One equilibrium in short.
struct StateSummary {
  double R_tot = 0.0;
  std::optional<double> F0;
  double end_force = 0.0, end_moment = 0.0;  ///< struts
  double energy = 0.0;                       ///< elastic [EI/ρ]
  double potential = 0.0;                    ///< see potential()
  int index = 0;                             ///< negative directions of the whole rod
  std::string topology;
  Restart restart;
};

/// In short, with its index where the load has a potential, −1 otherwise.
StateSummary summarised(const Started& state, const scene::Scene& natural);

struct Equilibria {
  Solution answer;
  std::vector<StateSummary> states;  ///< all that were found, the answer first
};

/// `solve`: the stable equilibrium at the scene's loads, of lowest potential where search() finds several, on the first of
/// the rungs closed form, planar, Kirchhoff half, Kirchhoff full that holds it; the answer names the rung and the reason.
/// @throws NoEquilibrium, saying what was searched
Equilibria equilibria(const scene::Scene& scene);

/// Of states whose indices are known, as those of dragged ones are from their spectra, the first stable one becomes the answer.
/// @param scene  that of equilibria(), determinate
void answer_with_stable(Equilibria& found, const scene::Scene& scene);

}  // namespace windlass::equilibrium
