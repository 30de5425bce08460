#pragma once

#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Friction with a moment about the centre line, `rod.radius` away from where it acts (PHYSICS, "The moment of the friction").
namespace windlass::equilibrium {

/// Is the moment honoured on these contacts? At isolated touches and along lines of the cylinder, not where strands touch, nor where
/// cylinder and plate hold the rod at one place; a coil that lies in the plate all along has it by other means (flat_torsion.hpp).
bool carries_couple(const Topology& topology);

/// What is said of a scene whose states would need it elsewhere.
std::string couple_not_carried();
/// What is said where a rod on a plate's outer edge would be followed in its radius, which the edge's is, too.
std::string rim_not_thickened();

/// Steady states that have left the plate, followed from those without the moment by the radius at which friction acts.
/// @param searched  for people: what was followed, and what was not
std::vector<Started> dragged_with_couple(const scene::Scene& scene, const std::vector<std::string>& keys,
                                         std::string& searched);

}  // namespace windlass::equilibrium
