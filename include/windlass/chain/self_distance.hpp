#pragma once

#include <optional>

#include "windlass/chain/profile.hpp"

namespace windlass::chain {

/// Closest approach of a rod to itself [ρ], and the two places, s1 < s2.
struct SelfDistance {
  double distance = 0.0, s1 = 0.0, s2 = 0.0;
};

/// The least local minimum of d(s1, s2) = |r(s2) − r(s1)| away from the diagonal, where d vanishes trivially; a minimum
/// at an end of the rod counts. There is none where the rod nowhere comes back to itself.
///
/// Neighbours exclude themselves: where d is stationary in both places the rod is normal to the chord at both, and by
/// Fenchel's theorem it turns by π or more in between (by π/2 at least where one of them is its end). With a radius,
/// pairs with s2 − s1 < π r do not count either: a tube as curved as its radius allows fits into them.
///
/// Pairs of stretches are bounded from below by the balls that hold them, |r(s) − r(c)| ≤ |s − c| since s is arclength,
/// and dropped where that exceeds the least minimum known, where the rod turns too little, or where no direction in the
/// ball of chords is normal to the tangents: for a rod of N elements some N log N pairs are looked at. Minima are
/// refined by a damped Newton method on the quintic through r, r′, r″ between samples.
///
/// @param whole   of the whole rod, from s = −L/2
/// @param radius  of the rod [ρ]; 0: not given
std::optional<SelfDistance> self_distance(const Profile& whole, double radius);

/// Where two links come nearest to each other, at a local minimum of their distance, of those under three times 2r.
struct Approach {
  int link = 0, other = 0;  ///< of the chain, link >= other
  bool mirrored = false;    ///< half chain: the other is the image of that link
  double distance = 0.0, s = 0.0, s_other = 0.0;
};

/// One for every pair of links of a thick rod, images of each other once, in a fixed order for a given topology. Touches that
/// there are do not count.
std::vector<Approach> approaches(const Profile& profile, const Topology& topology);

}  // namespace windlass::chain
