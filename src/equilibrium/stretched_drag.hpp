#pragma once

#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Rods that stretch while a cylinder slips along them (PHYSICS, "Stretch while sliding").
namespace windlass::equilibrium {

/// Are the equations of a rod that stretches built for these contacts? Along lines of the cylinder not beside strands, where a line
/// leaves the plate or with others that lie on it; in a rod that runs along itself along none but those of the flat coil, which by
/// its symmetry does not.
bool carries_stretch(const Topology& topology, chain::Travel travel);

/// What is said of a scene whose states would need it elsewhere.
std::string stretch_not_carried();

/// Steady states that have left the plate, followed from those of the rod that does not stretch by its compliance.
/// @param searched  for people: what was followed, and what was not
std::vector<Started> dragged_with_stretch(const scene::Scene& scene, const std::vector<std::string>& keys,
                                          std::string& searched);

}  // namespace windlass::equilibrium
