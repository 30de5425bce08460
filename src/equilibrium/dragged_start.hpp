#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// First states of a rod that a cylinder slips along and a plate holds back (PHYSICS, "Steady sliding").
namespace windlass::equilibrium {

/// A state without friction, put under the plate: its highest tail touches the plate, and the rest of that tail lies flat in it.
/// The cylinder drags by a little friction; from there on `reach` leads to the scene's.
/// @param still    in contact with the cylinder only; one or both of its tails rise to its highest place
/// @param failure  why there is none
std::optional<Started> under_the_plate(const Started& still, const scene::Scene& scene, double friction,
                                       std::string& failure);

}  // namespace windlass::equilibrium
