#pragma once

#include "windlass/chain/strands.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// What the touches say that a line between strands consists of.
namespace windlass::equilibrium {

/// The line that a link is between two touches of, with others; −1: none. Touches inside a line are where they are laid.
int line_of_several(const chain::Strands& strands, int link);

/// A line between strands needs its touches, or has more than it needs.
ContactEvent spare_touches(const chain::Profile& profile, const chain::Strands& strands, int link, int line);

/// Of a line between strands the touches inside may pull, as its pressure changes its sign, with what would open the strands by
/// no more than they may be nearer elsewhere: a force F lifts both over the span h of its neighbours by Fh³/12B.
double carried_pull(const chain::Profile& profile, const chain::Strands& strands, int joint);

}  // namespace windlass::equilibrium
