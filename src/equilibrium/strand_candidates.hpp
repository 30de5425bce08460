#pragma once

#include <vector>

#include "strand_line_events.hpp"
#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// Candidates for what follows an event between strands of the rod, most likely first.
namespace windlass::equilibrium {

/// What follows where an arc has no length left, or a touch of strands comes apart. Joints that locate themselves meet and part; the
/// touches inside lines follow them.
std::vector<Successor> after_skeleton(const ContactEvent& event, const chain::Profile& profile,
                                      const chain::Topology& topology, const Strip& strip);

/// Strands that meet where one of them lies flat in a plate, right behind the plate's touch: it stays there.
std::vector<Successor> strands_meet_in_plate(const ContactEvent& event, const Strip& strip,
                                             const chain::Profile& profile, const chain::Topology& topology);

/// Two touches that a touch between them stands for (touch_dip.hpp): where their forces together are.
std::vector<Successor> become_one(int link, const chain::Profile& profile, const chain::Topology& topology,
                                  const Strip& strip);

/// The touches of lines laid anew, a line with the own image open about its middle where that is why.
std::vector<Successor> laid_anew(const LaidAnew& here, const chain::Profile& profile,
                                 const chain::Topology& topology, const Strip& strip);

/// Do strands meet where a line of theirs is open about its middle?
bool opens_line(const ContactEvent& event, const chain::Topology& topology);

/// Are the joints about a place where they were, but for what is little next to the distance between them?
bool alike(const Successor& next, const Strip& strip, double s);

}  // namespace windlass::equilibrium
