#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Starts of rods between two plates (PHYSICS, "Two plates").
namespace windlass::equilibrium {

/// The scene without its second plate; without both, where nothing slides, for a rod that one plate does not push.
scene::Scene with_one_plate(const scene::Scene& scene);

/// A state of that scene with the second plate: where it is, if the rod has room, else brought there from beyond the rod.
/// @param failure  why it was not reached
std::optional<Started> between_plates(const Started& found, const scene::Scene& scene,
                                      const std::vector<std::string>& keys, std::string& failure);

}  // namespace windlass::equilibrium
