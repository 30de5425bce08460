#pragma once

#include <vector>

#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// Candidates for what follows an event between the rod and its obstacles, most likely first.
namespace windlass::equilibrium {

/// Where a line pulls: gaps of several lengths in it or at its ends, or all of it open.
std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip,
                                      const chain::Profile& profile);

/// A line that has this length or less at an event shrinks to nothing there.
bool vanishes(const Strip& strip, int link);

/// An arc has no length left, and others with it.
std::vector<Successor> after_length(int link, const Strip& strip);

/// A touch lifts off.
std::vector<Successor> after_force(const ContactEvent& event, Strip strip, const chain::Profile& profile,
                                   const chain::Topology& topology);

/// A touch is two, a stretch of a line, or with those beside it a gap that closes.
std::vector<Successor> after_curvature(const ContactEvent& event, const Strip& strip,
                                       const chain::Profile& profile);

/// The rod touches an obstacle between contacts.
std::vector<Successor> after_graze(const ContactEvent& event, const Strip& strip,
                                   const chain::Profile& profile);

/// What touches at the rod's end need not be tangent there: another mechanics.
Successor end_of_rod(const Strip& strip);

/// What touches a plate at its outer edge presses on that edge next, which comes behind it in the scene, and the other way round. Lines
/// and strands do not, nor what reaches the plate's outer side.
Successor past_the_rim(const ContactEvent& event, Strip strip, const chain::Profile& profile);

/// A line that has buckled off its obstacle: its edges are touches now.
Successor bowed(int link, Strip strip);

}  // namespace windlass::equilibrium
