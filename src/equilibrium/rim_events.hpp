#pragma once

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/obstacle/rim.hpp"

/// What happens at the outer edge of a plate.
namespace windlass::equilibrium {

/// How far a place is inside the outer edge of an obstacle; infinite where it has none.
double inside_rim(const obstacle::Surface& surface, const Eigen::Vector3d& r);

/// How far a free arc passes outside the edge of a plate, where it goes from under the plate to beyond and rises: the distance of the
/// edge from its way in the plane (e_r, e_z), which is signed. Where it does not rise a touch of the plate itself comes first.
ContactEvent graze_of_rim(const chain::Profile& profile, const obstacle::Rim& rim, int obstacle, int link);

/// Touches of a plate at its outer edge are touches of that edge, and those of the edge with a force along the plate's normal touches
/// of the plate; where the force is along the plate its outer side begins.
ContactEvent rim_event(const chain::Profile& profile, const chain::Contact& c);

}  // namespace windlass::equilibrium
