#pragma once

#include <optional>

#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// Where a line pulls right up to a strand that presses on it, and opens past the strand (PHYSICS, "A gap beside a strand that
/// presses").
namespace windlass::equilibrium {

/// Forces F by which strands press a line to its obstacle at its two ends, where it goes on beyond them [EI/ρ²]; 0: none does.
struct Presses {
  double begin = 0.0, end = 0.0;
};
Presses presses_on(const chain::Profile& profile, int link);

/// Where a line pulls right up to a strand that presses on it by F the moment does not jump there, and is none in the line beyond: so
/// the line cannot open up to the strand. It ends d beyond it, on an edge that takes F, and is free from there past the strand:
/// F d is the moment on the gap's end. With the pull ε − a σ on the way σ from the strand the gap is 5ε/3a long, as beside a touch, and
/// F d = a b³/60 for its length b (see above).
/// @param at_end  the strand is at the end of the line, else at its beginning
/// @returns d for a gap of this length [both ρ]
double lever_under_press(const chain::Piece& line, bool at_end, double gap, double force);

/// The gap beside a strand that presses and that way from it to the other edge, the shorter of the two, as links.
struct OpenedPress {
  int gap = -1, lever = -1;
};
/// The two that a link is one of; nothing where it is none.
std::optional<OpenedPress> opened_press(const chain::Profile& profile, const chain::Topology& topology,
                                        int link);
/// Of such a gap, over what its line would carry: see ContactEvent::Kind::suction.
double part_of_carried(const chain::Profile& profile, const OpenedPress& opened);

/// How far the edge of a gap beside a strand that presses is beyond the strand, over what its line carries: an arc that can be solved
/// for; as long as the rod rises by no more than a certificate takes for nothing.
/// @param pull   of the line at the strand [EI/ρ³]; @param width  on which it pulls [ρ]; @param force  of the strand [EI/ρ²]
double part_beside_press(double pull, double width, double force);

/// The force by which a strand presses a line to its obstacle at this joint inside of it. Nothing: none does.
std::optional<double> pressed_by(const chain::Profile& profile, const Strip& strip, int joint);

/// The line has opened beside the strand, over `gap`, and to the strand's other side over the lever.
/// @param link    the line that pulls; @param at_end  the strand is at its end, else at its beginning
Successor opened_under_press(int link, Strip strip, const chain::Profile& profile, bool at_end, double gap);

/// A line between such a strand and its own edge pulls all along: it opens as a whole, and its edge is a touch. With the pull ε
/// over the length ℓ, held at both ends, F d = εℓ²/12.
Successor lifted_beside_press(int link, Strip strip, const chain::Profile& profile, bool at_end);

/// The gap is carried by its line again, and the strand presses on that.
Successor closed_under_press(const OpenedPress& opened, Strip strip);

}  // namespace windlass::equilibrium
