#include <algorithm>
#include <cmath>
#include <utility>

#include "candidates.hpp"
#include "end_events.hpp"
#include "line_touches.hpp"
#include "strand_successors.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

using chain::Profile;
using chain::Stretch;
using chain::Topology;

namespace {

/// The same with the change made on both sides of s = 0: the side that changed and its mirror image.
/// @param links  of the old chain
Successor mirrored(const Successor& next, bool right_changed, const Profile& profile) {
  const int links = static_cast<int>(profile.pieces.size());
  // Bounds and stretches of the side that changed, from the middle outward.
  const int count = static_cast<int>(next.topology.stretches.size());
  const auto bound = [&](int k) { return right_changed ? next.s[k] : -next.s[count - k]; };
  const auto link = [&](int k) { return right_changed ? k : count - 1 - k; };
  const auto seat = [&](int k, bool image) {
    const int joint = right_changed ? k : count - k;
    chain::Seat out = next.topology.seat(joint);
    if (image) out.strand = image_strand(next, joint);
    if (image) out.line = image_line(next, joint);
    if (image && out.part > 0.0) out.part = 1.0 - out.part;
    if (image) out.shares = -out.shares;
    return out;
  };
  constexpr double middle = 1e-9;
  int first = 0;  // first bound beyond the middle
  while (bound(first) <= middle) ++first;
  const bool touches = first > 1 && std::abs(bound(first - 1)) <= middle;  // at the middle itself
  Successor out;
  out.topology.half = false;
  const auto add = [&](int k, bool image) {
    const int source = next.source[link(k)], same = right_changed ? source : links - 1 - source;
    const bool fresh = std::find(next.opened.begin(), next.opened.end(), link(k)) != next.opened.end();
    if (fresh) out.opened.push_back(static_cast<int>(out.topology.stretches.size()));
    out.topology.stretches.push_back(next.topology.stretches[link(k)]);
    out.source.push_back(image ? links - 1 - same : same);
  };
  for (int k = count; k-- > first;) add(k, true);
  const auto add_bound = [&](double s, int k) {
    out.s.push_back(s);
    if (next.topology.on.empty()) return;
    out.topology.on.push_back(seat(k, s < 0.0));
    if (s != 0.0 && (s > 0.0) != right_changed)
      out.topology.on.back().obstacle = image_of(profile, out.topology.on.back().obstacle);
  };
  for (int k = count; k >= first; --k) add_bound(-bound(k), k);
  if (touches) {
    add(first - 1, true);
    add_bound(0.0, first - 1);
  }
  for (int k = first - 1; k < count; ++k) add(k, false);
  for (int k = first; k <= count; ++k) add_bound(bound(k), k);
  out.nothing_left = !out.topology.contact();
  return out;
}

/// Where the gaps on both sides of a touch have closed at once, the lines that meet there are one.
void join_lines(Successor& next) {
  std::vector<Stretch>& stretches = next.topology.stretches;
  for (std::size_t i = 0; i + 1 < stretches.size();) {
    const int joint = static_cast<int>(i) + 1;  // a strand presses between, or the plate
    const bool apart = next.topology.seat(joint).strand != 0 || next.topology.lifts_off(joint);
    if (stretches[i] != Stretch::line || stretches[i + 1] != Stretch::line || apart) {
      ++i;
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(i) + 1;
    stretches.erase(stretches.begin() + at);
    next.source.erase(next.source.begin() + at);
    next.s.erase(next.s.begin() + at);
    if (!next.topology.on.empty()) next.topology.on.erase(next.topology.on.begin() + at);
    for (int& link : next.opened) link -= link > static_cast<int>(i);
  }
}

/// Does a touch say that it is at the place of one that is elsewhere now, or gone?
bool parted(const Successor& next) {
  const auto count = static_cast<int>(next.s.size());
  for (int j = 0; j < count; ++j) {
    const int shares = next.topology.seat(j).shares, at = j + shares;
    if (shares != 0 &&
        (at < 0 || at >= count || next.s[at] != next.s[j] || next.topology.seat(at).strand == 0))
      return true;
  }
  return false;
}

bool symmetric(const Topology& topology, const std::vector<double>& s, const Profile& profile) {
  constexpr double same = 1e-4;  // short gaps amplify rounding; what is built on it is solved and checked
  if (topology.half ||
      !std::equal(topology.stretches.begin(), topology.stretches.end(), topology.stretches.rbegin()))
    return false;
  const int last = static_cast<int>(s.size()) - 1;
  for (int j = 0; j <= last; ++j)
    if (!(std::abs(s[j] + s[last - j]) < same) ||
        topology.obstacle(j) != image_of(profile, topology.obstacle(last - j)))
      return false;
  return true;
}

/// Is it its own mirror image?
bool is_symmetric(const Successor& next, const Profile& profile) {
  return symmetric(next.topology, next.s, profile);
}

/// Does a strand press right where a line ends, or leaves the plate? No joint is that.
bool presses_at_an_end(const Topology& topology) {
  const auto line = [&](int link) { return topology.stretches[link] == Stretch::line; };
  for (int j = 1; j < static_cast<int>(topology.stretches.size()); ++j)
    if (topology.seat(j).strand != 0 &&
        (line(j - 1) != line(j) || topology.lies_flat(j - 1) != topology.lies_flat(j)))
      return true;
  return false;
}

}  // namespace

std::vector<Successor> successors(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                  const std::vector<double>& s) {
  std::vector<Successor> out;
  for (Successor& next : one_sided(event, profile, topology, s)) {
    if (parted(next)) next = with_touches(skeleton_of(Strip(next)).strip.successor(), profile, topology);
    // Of a symmetric state mirror images go together.
    if (symmetric(topology, s, profile) && !is_symmetric(next, profile))
      out.push_back(mirrored(next, event.s > 0.0, profile));
    out.push_back(std::move(next));
  }
  for (Successor& next : out) {
    join_lines(next);
    if (next.topology.couplings().empty()) continue;
    Strip strip(next);  // what ends beside a line makes it longer or shorter, too
    measure_parts(strip);
    next.topology = strip.successor().topology;
  }
  std::erase_if(out, [](const Successor& next) { return presses_at_an_end(next.topology); });
  return out;
}

}  // namespace windlass::equilibrium
