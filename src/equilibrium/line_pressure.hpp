#pragma once

#include <array>

#include "windlass/equilibrium/contact_events.hpp"

/// The pressure of a line contact: where it pulls, and what of that the line carries for a gap.
namespace windlass::equilibrium {

/// Value of an event that is nowhere near: no local minimum of the gap, say.
inline constexpr double far = 1.0;

/// Forces F by which strands press a line to its obstacle at its two ends, where it goes on beyond them [EI/ρ²]; 0: none does.
struct Presses {
  double begin = 0.0, end = 0.0;
};
Presses presses_on(const chain::Profile& profile, int link);

/// Where a line pulls right up to a strand that presses on it by F the moment does not jump there, and is none in the line beyond: so
/// the line cannot open up to the strand. It ends d beyond it, on an edge that takes F, and is free from there past the strand:
/// F d is the moment on the gap's end. With the pull ε − a σ on the way σ from the strand the gap is 5ε/3a long, as beside a touch, and
/// F d = a b³/60 for its length b (PHYSICS, "A gap beside a strand that presses").
/// @param at_end  the strand is at the end of the line, else at its beginning
/// @returns d for a gap of this length [both ρ]
double lever_under_press(const chain::Piece& line, bool at_end, double gap, double force);

/// Is a link such a way, from a line's edge to a strand that presses, with a gap to a line again behind that?
bool is_lever(const chain::Topology& topology, int link);

/// The events `pressure` and `suction` of a line.
/// @param from_mid  it begins at the mid-point of a half chain, and goes on in its image
std::array<ContactEvent, 2> pressure_and_suction(const chain::Piece& line, int link, bool from_mid,
                                                 const Presses& presses = {});

}  // namespace windlass::equilibrium
