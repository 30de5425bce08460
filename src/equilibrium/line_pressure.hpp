#pragma once

#include <array>

#include "opened_press.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// The pressure of a line contact: where it pulls, and what of that the line carries for a gap.
namespace windlass::equilibrium {

/// Value of an event that is nowhere near: no local minimum of the gap, say.
inline constexpr double far = 1.0;

/// The events `pressure` and `suction` of a line.
/// @param from_mid  it begins at the mid-point of a half chain, and goes on in its image
std::array<ContactEvent, 2> pressure_and_suction(const chain::Piece& line, int link, bool from_mid,
                                                 const Presses& presses = {});

}  // namespace windlass::equilibrium
