#pragma once

#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

/// Beyond its last contact nothing pushes a rod round a cylinder out of the plane of its pull and its tangent: behind a touch of a
/// plate that tail lies flat in the plate, with neither gap nor curvature there (PHYSICS, "Steady sliding"). So does all that is
/// free beside a touch of cylinder and plate at once.
bool lies_flat(const chain::Profile& profile, const chain::Topology& topology, int link, int obstacle);

}  // namespace windlass::equilibrium
