#pragma once

#include <string>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::equilibrium {

/// The state that a stored one becomes when a parameter moves to another value: walks the branch there, through contact
/// events. The index is counted (Solution::stability without eigenvalues).
///
/// @param scene   of the run the state comes from
/// @param stored  a state with restart data
/// @param key     dotted scene key that moves, e.g. "load.tension"
/// @param target  its value at the end [dimensionless]
/// @throws NoEquilibrium if the branch folds back, ends, or is lost before
Solution follow(scene::Scene scene, const Solution& stored, const std::string& key, double target);

}  // namespace windlass::equilibrium
