#pragma once

#include "windlass/chain/topology.hpp"

/// Units in which events, entries into new topologies and starts compare: lengths are in radii of the cylinder already.
namespace windlass::equilibrium {

struct Scales {
  double force = 1.0;     ///< B/ρ²: what bends the rod round the cylinder
  double pressure = 1.0;  ///< B/ρ³
};

inline Scales scales_of(const chain::RodKind& rod) { return {rod.bending_stiffness, rod.bending_stiffness}; }

/// Height of a gap that stays without an arc of its own [ρ]: the line's shape is the rod's to this. A tenth of the
/// certificate's bound on positions.
inline constexpr double micro_height = 1e-10;

/// Part of it at which an arc is given up. Heights go like the sixth power of lengths: the arc is half as long as where
/// it was made, its edge forces, like the third power, still a million times rounding.
inline constexpr double arc_height = 0.02 * micro_height;

}  // namespace windlass::equilibrium
