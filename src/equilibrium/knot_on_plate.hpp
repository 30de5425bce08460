#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// Knots below a plate, and those that a cylinder slips through (PHYSICS, "Steady sliding").
namespace windlass::equilibrium {

/// A knot of the scene below its plate, on the full chain. Without a cylinder that slides: where it is, or so far down that it is
/// clear of the plate, which no force presses it on. Else the knot without friction, loose, put under the plate that its highest
/// place then touches; the cylinder's friction grows from next to nothing to the scene's, then its tension.
/// @param failure  why there is none
std::optional<Started> knot_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                     std::string& failure);

}  // namespace windlass::equilibrium
