#pragma once

#include "windlass/chain/strands.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

/// How far an arc is from having no length, or none that stands for something.
ContactEvent length_event(const chain::Profile& profile, const chain::Topology& topology,
                          const chain::Strands& strands, int i);

}  // namespace windlass::equilibrium
