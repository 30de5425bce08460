#pragma once

#include "windlass/chain/profile.hpp"

namespace windlass::chain {

/// Right half of a ring, s ∈ [0, half_length]: a strut whose ends meet at the origin, both along e_x, closed by one full
/// turn of loads.twist, the rest of which is spread evenly. Mid-point at (0, ±2R, 0) with tangent −e_x, where the
/// half-turn frame has ψ = π (spatial::MidGap). Frames are continuous up to the end's own quaternion.
Profile ring_profile(const Loads& loads);

}  // namespace windlass::chain
