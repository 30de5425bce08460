#pragma once

#include <optional>

#include "windlass/chain/profile.hpp"
#include "windlass/chain/strands.hpp"

/// **Two contacts that have just come from a touch between free strands are carried by it.** Beside a touch with a force F between
/// strands of stiffness B their distance is D = 2r + ½ G″σ² + k|σ|³ + qσ⁴/24, k = F/6B where the strands are parallel: where G″ < 0
/// they are nearer than 2r by |G″|³/54k² at the distance |G″|/3k. What follows are two touches |G″|/3k apart, which share the force,
/// and a line between them where q < 0; long before these can be told apart the touch is the same state to all digits.
namespace windlass::equilibrium {

struct TouchDip {
  double nearer =
      0.0;  ///< how much nearer than 2r strands are beside the touch, on either side the most [ρ]; 0 for G″ >= 0
  double part = 0.0;  ///< of what a touch carries: by that, or by what is seen of the strands beside it
  double from = 0.0,
         to = 0.0;       ///< ends of the line, or the gap, that the touch stands for, along its strand [ρ]
  bool presses = false;  ///< is it a line?
};

/// Of a touch between two free strands; nullopt: none that stands for contacts on both sides of it, or G″ is not small.
std::optional<TouchDip> dip_beside_touch(const chain::Profile& profile, const chain::Strands& strands,
                                         const chain::Contact& touch);

/// Of two touches of the same two free strands next to each other at the ends of a link, with nothing else between: their distance
/// over the one that a touch would carry. nullopt: none of these.
std::optional<double> part_of_carried(const chain::Profile& profile, const chain::Strands& strands, int link);

}  // namespace windlass::equilibrium
