#pragma once

#include <vector>

#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// What follows where a rod that a cylinder slides through begins or ceases to lie in the plate that holds it back.
namespace windlass::equilibrium {

/// A line on cylinder and plate loses its pressure all along at once, and with it the line that leaves the plate beside it begins to
/// lift off the cylinder: what was between is a gap in the plate, from the plate's touch, whose force stays, to the other end.
std::vector<Successor> flat_line_lifts(int link, const Strip& strip, const chain::Profile& profile);

/// Where the edge of a line and a touch of the plate meet, beyond which the rod lies flat in the plate, the line itself reaches the
/// plate and lies on both from there on; and the other way round. Where a touch of the cylinder, or of another strand, and one of
/// the plate meet they change places: the rod lies flat from the plate's touch on, and the other is one of both. What lies in the plate
/// may be a tail, or a line on it. Nothing for other arcs.
std::vector<Successor> flat_line_begins_or_ends(int link, const chain::Profile& profile, const Strip& strip);

}  // namespace windlass::equilibrium
