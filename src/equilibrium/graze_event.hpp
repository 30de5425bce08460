#pragma once

#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

/// Does a tail beside this touch lie flat in its obstacle?
bool before_flat_tail(const chain::Profile& profile, const chain::Topology& topology,
                      const chain::Contact& c);

/// Least local minimum of the gap to an obstacle inside a free arc. Next to a contact the gap is flat and its samples are
/// rounding; a minimum must stand out by more than that.
ContactEvent graze(const chain::Profile& profile, const chain::Topology& topology, int obstacle, int link,
                   bool starts_at_mid);

}  // namespace windlass::equilibrium
