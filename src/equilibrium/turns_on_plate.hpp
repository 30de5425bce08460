#pragma once

#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Thick coils of several turns on a plate (PHYSICS, "Turns beside each other").
namespace windlass::equilibrium {

/// Do turns press on each other at this tension, as those of a thick coil that would lie on itself if it were flat?
bool turns_press(const scene::Scene& scene);

/// Coils whose turns press on each other, from the tension at which they lie apart without friction.
/// @param searched  for people: what was followed
std::vector<Started> turns_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched);

}  // namespace windlass::equilibrium
