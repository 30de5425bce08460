#pragma once

#include <optional>

#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::output {

/// Negative eigenvalues on the stretch of a branch between two consecutive rows: those of the ordinary one, since a
/// special point's own count belongs to either side.
inline std::optional<int> index_between(const BranchRow& first, const BranchRow& second) {
  return first.label.empty() ? first.index : second.index;
}

/// The stable state of a run in load.tension at a tension between its points, or above the highest: continued from the
/// nearest stored point of a stretch of index 0, so it is as accurate as the points themselves.
/// @param scene    of the run
/// @param tension  [EI/ρ²]
/// @return         nullopt where the run has no stable state at that tension
std::optional<equilibrium::Solution> stable_state(const Run& run, const scene::Scene& scene, double tension);

/// R_tot of that state [EI/ρ²]. Where it cannot be continued to (a contact that has just opened, say), interpolated in
/// logarithms between its neighbours, if they are within a tenth of the tension of each other.
std::optional<double> stable_contact_force(const Run& run, const scene::Scene& scene, double tension);

}  // namespace windlass::output
