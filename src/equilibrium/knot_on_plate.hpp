#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Knots below a plate, and those that a cylinder slips through (PHYSICS, "Steady sliding").
namespace windlass::equilibrium {

/// A knot without friction, on the full chain and at any height, put under the plate: its highest place touches it, and the
/// cylinder drags by a little friction; continuation in it leads to the scene's.
/// @param still    in contact with the cylinder and itself only
/// @param failure  why there is none
std::optional<Started> knot_under_plate(const Started& still, const scene::Scene& scene, double friction,
                                        std::string& failure);

}  // namespace windlass::equilibrium
