#pragma once

#include <vector>

#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

/// Candidates for what follows an event, most likely first, the other half of a symmetric full chain left as it is.
std::vector<Successor> one_sided(const ContactEvent& event, const chain::Profile& profile,
                                 const chain::Topology& topology, const std::vector<double>& s);

}  // namespace windlass::equilibrium
