#pragma once

#include <vector>

#include "strip.hpp"
#include "windlass/chain/profile.hpp"

/// The touches inside lines between free strands: what is meshed, where joints that locate themselves are the skeleton.
namespace windlass::equilibrium {

/// A strip without the touches inside such lines.
struct Skeleton {
  Strip strip;
  std::vector<int> joint, link;  ///< of the strip it was made of, in this one; −1: it is inside a line
};
Skeleton skeleton_of(const Strip& strip);

/// Lays the touches inside the lines of a skeleton: between joints next to each other so many that with the pressure p of the state
/// that `profile` shows strands come nearer by a quarter of what is carried, spaced by p^-¼.
/// @param finer  more of them by this factor
Successor with_touches(const Successor& skeleton, const chain::Profile& profile,
                       const chain::Topology& topology, double finer = 1.0);

}  // namespace windlass::equilibrium
