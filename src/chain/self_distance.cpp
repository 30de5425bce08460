#include "windlass/chain/self_distance.hpp"

#include <algorithm>
#include <cmath>

#include "closest_pair.hpp"
#include "windlass/chain/guess.hpp"

namespace windlass::chain {

namespace {

/// Places of the touches between strands, of the whole rod: first place < second place.
std::vector<Touch> touches(const Profile& profile, const Topology& topology) {
  // Two touches so close are told apart by their curvature; that of a line's end says nothing [ρ].
  constexpr double same_touch = 1e-2, same_end = 2e-3;
  std::vector<Touch> out;
  const Strands strands(topology);
  const auto add = [&](double a, double b, double reach) {
    out.push_back({{std::min(a, b), std::max(a, b)}, reach});
  };
  const auto place = [&](int joint) { return profile.contact_at(joint)->s; };
  for (const Coupling& c : topology.couplings()) {
    const double a = place(c.first), b = c.mirrored ? -place(c.second) : place(c.second);
    const int line = strands.line_of(c.first);
    const double reach = line >= 0 && !strands.lines()[line].on_obstacles ? same_end : same_touch;
    add(a, b, reach);
    if (topology.half) add(-a, -b, reach);
  }
  return out;
}

}  // namespace

std::vector<Approach> approaches(const Profile& profile, const Topology& topology) {
  std::vector<Approach> out;
  if (profile.radius == 0.0) return out;
  Profile image;
  if (topology.half) image = unfolded(profile, topology.symmetry);
  const Profile& whole = topology.half ? image : profile;
  const Centreline curve(whole);
  const std::vector<Touch> known = touches(profile, topology);
  const double separation = M_PI * profile.radius;
  constexpr double as_far_again = 2.0;  // nobody asks how far strands are that are this far
  const double cutoff = 2.0 * profile.radius * (1.0 + as_far_again);
  const int links = static_cast<int>(profile.pieces.size()), first = topology.half ? links : 0;
  // Touches of a line are where they are laid, not where strands are nearest: right beside they may be nearer.
  const std::vector<Touch> none;
  const auto least =
      [&](int i, int j, bool line) -> std::optional<SelfDistance> {  // of two pieces of the whole rod, i <= j
    for (const int piece : {i, j})
      if (curve.begins[piece] == curve.begins[piece + 1]) return std::nullopt;  // of no length
    ClosestPair search(curve, separation, cutoff, line ? none : known);
    if (i == j)
      search.within(curve.begins[i], curve.begins[i + 1]);
    else
      search.between(curve.begins[i], curve.begins[i + 1], curve.begins[j], curve.begins[j + 1]);
    return search.best();
  };
  const auto add = [&](int i, int j, bool mirrored, bool line) {
    const auto found = mirrored ? least(links - 1 - j, first + i, line) : least(first + j, first + i, line);
    Approach near{i, j, mirrored, cutoff};
    if (found) {
      near.distance = found->distance;
      near.s = found->s2;
      near.s_other = mirrored ? -found->s1 : found->s1;
    }
    out.push_back(near);
  };
  const Strands strands(topology);
  std::vector<int> in_line(links);
  for (int i = 0; i < links; ++i) in_line[i] = strands.line_along(i);
  for (int i = 0; i < links; ++i)
    for (int j = 0; j <= i; ++j) {
      // Of two lines between strands a link is near what faces it only.
      const bool along = in_line[i] >= 0 && in_line[j] >= 0;
      const auto look = [&](bool image) {
        const Strands::Facing* faced = strands.facing(i, j, image);
        if (faced || !along)
          add(i, j, image, faced && faced->line >= 0 && !strands.lines()[faced->line].on_obstacles);
      };
      look(false);
      if (topology.half) look(true);
    }
  return out;
}

std::optional<SelfDistance> self_distance(const Profile& whole, double radius) {
  if (whole.pieces.empty() || whole.pieces.front().s.size() < 2) return std::nullopt;
  const Centreline curve(whole);
  ClosestPair search(curve, M_PI * radius);
  search.within(0, curve.size());
  return search.best();
}

}  // namespace windlass::chain
