#pragma once

#include "couple_shooting.hpp"

namespace windlass::test {

/// Shooting, independent of the solver, for a rod that lies along one line on a cylinder that slides, with the moment of the friction,
/// the stretch of the rod, or both, and travel blocked, and touches a plate with its right tail: the first-order equations in space,
/// the pressure that of the force along the normal, p = (ν − n·N)/w, w > 0, from the layer at the right edge inward.
/// @param guess  a solution on those contacts
Dragged shot_from_line(const equilibrium::Solution& guess, const scene::Scene& scene);

}  // namespace windlass::test
