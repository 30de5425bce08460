#pragma once

#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Friction with a moment about the centre line, `rod.radius` away from where it acts (PHYSICS, "The moment of the friction").
namespace windlass::equilibrium {

/// Is the moment honoured on these contacts? At isolated touches, not along lines, and not where cylinder and plate hold the
/// rod flat at one place: twisted, it does not lie there.
bool carries_couple(const Topology& topology);

/// What is said of a scene whose states would need it elsewhere.
std::string couple_not_carried();
/// What is said where a rod on a plate's outer edge would be followed in its radius, which the edge's is, too.
std::string rim_not_thickened();

/// Steady states of touches alone, followed from those without the moment by the radius at which friction acts.
/// @param searched  for people: what was followed, and what was not
std::vector<Started> dragged_with_couple(const scene::Scene& scene, const std::vector<std::string>& keys,
                                         std::string& searched);

}  // namespace windlass::equilibrium
