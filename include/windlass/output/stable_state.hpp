#pragma once

#include <optional>
#include <vector>

#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::output {

/// Negative eigenvalues on the stretch of a branch between two consecutive rows: those of the ordinary one, since a
/// special point's own count belongs to either side.
inline std::optional<int> index_between(const BranchRow& first, const BranchRow& second) {
  return first.label.empty() ? first.index : second.index;
}

/// Consecutive rows of one branch between which every state is stable.
struct StableStretch {
  std::size_t first = 0, last = 0;     ///< rows of the run
  double lowest = 0.0, highest = 0.0;  ///< tensions it covers [EI/ρ²]
};

/// @return those of a run in load.tension, the one that reaches the highest tension first
std::vector<StableStretch> stable_stretches(const Run& run);

/// The stable state of a run in load.tension at a tension between its points, or above the highest: continued from the
/// nearest stored point, so it is as accurate as the points themselves. Where several states are stable, the one of the
/// stretch that reaches the highest tension: what a rod is in that was tightened first and slackened then.
/// @param scene    of the run
/// @param tension  [EI/ρ²]
/// @return         nullopt where the run has no stable state at that tension
std::optional<equilibrium::Solution> stable_state(const Run& run, const scene::Scene& scene, double tension);

/// Where a force comes from.
enum class ForceSource {
  computed,   ///< an equilibrium at that tension, between points of the run
  above_run,  ///< an equilibrium too, at a tension above all of the run's, where no point tells of instability
  interpolated,  ///< in logarithms between two points within a tenth of the tension of each other
};

struct StableForce {
  double R_tot = 0.0;  ///< [EI/ρ²]
  ForceSource source = ForceSource::computed;
};

/// R_tot of stable_state(); interpolated where that state cannot be continued to (a contact that has just opened, say).
std::optional<StableForce> stable_contact_force(const Run& run, const scene::Scene& scene, double tension);

}  // namespace windlass::output
