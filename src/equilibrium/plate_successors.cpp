#include "plate_successors.hpp"

#include <utility>

namespace windlass::equilibrium {

using chain::Profile;
using chain::Stretch;

std::vector<Successor> flat_line_lifts(int link, const Strip& strip, const Profile& profile) {
  constexpr double unpressed = 1e-6;
  const auto flat = [&](int i) {
    return strip.is_line(i) && strip.on[i].flat >= 0 && profile.pieces[i].p.maxCoeff() < unpressed;
  };
  const int i = flat(link) ? link : flat(link - 1) ? link - 1 : link + 1;
  std::vector<Successor> out;
  if (!flat(i) || (!strip.is_line(i - 1) && !strip.is_line(i + 1))) return out;
  const chain::Seat plate{strip.on[i].flat}, cylinder{strip.on[i].obstacle};
  // Of p = a + b σ², σ from the place where it leaves the plate: lengths grow with the root of what is beyond the event, so that a
  // state beside it is sought.
  for (const double length : {0.2, 0.1, 0.3}) {
    const double gap = length * profile.unit_length;
    Strip next = strip;
    next.parts[i].kind = Stretch::gap;
    next.on[i].flat = -1;
    if (strip.is_line(i + 1)) {
      next.split(i + 1, strip.s[i + 1] + gap, Stretch::gap, Stretch::line, cylinder);
      next.on[i + 1] = plate;
    } else {
      next.on[i + 1].flat = plate.obstacle;
    }
    if (strip.is_line(i - 1)) {
      next.split(i - 1, strip.s[i] - gap, Stretch::line, Stretch::gap, cylinder);
      next.on[i + 1] = plate;
    } else {
      next.on[i].flat = plate.obstacle;
    }
    out.push_back(next.successor());
  }
  return out;
}

std::optional<Successor> flat_line_begins_or_ends(int link, const Profile& profile, const Strip& strip) {
  const int last = static_cast<int>(strip.parts.size()) - 1;
  if (strip.half || link < 1 || link >= last) return std::nullopt;
  const auto is_plate = [&](int joint) {
    const int obstacle = strip.on[joint].obstacle;
    return strip.on[joint].strand == 0 && obstacle > 0 && profile.obstacles[obstacle].curvature() == 0.0 &&
           profile.obstacles[0].slips();
  };
  constexpr double length = 0.05;
  Strip next = strip;
  next.parts[link].fresh = true;
  for (const bool rightward : {true, false}) {  // the way from the line to the end of the rod
    const int line = rightward ? link - 1 : link + 1, tail = rightward ? link + 1 : link - 1;
    const int inner = rightward ? link : link + 1, outer = rightward ? link + 1 : link;
    if (strip.is_line(tail) || (strip.parts[tail].kind != Stretch::tail && strip.plate_beside(tail) < 0))
      continue;
    if (!strip.is_line(line) && !strip.is_line(link)) {
      const bool flat = strip.on[outer].flat >= 0;
      const chain::Seat& other = strip.on[flat ? outer : inner];
      if (!is_plate(flat ? inner : outer) || other.line != 0 || (!flat && other.flat >= 0) ||
          (other.strand == 0 && other.obstacle != 0))
        continue;
      std::swap(next.on[inner], next.on[outer]);
      const int held = strip.on[flat ? inner : outer].obstacle;
      chain::Seat& moved = next.on[flat ? inner : outer];
      moved.flat = flat ? -1 : held;
      if (moved.strand != 0) moved.obstacle = flat ? 0 : held;
      next.s[outer] = strip.s[inner] + (rightward ? length : -length) * profile.unit_length;
      return next.successor();
    }
    if (!strip.is_line(line)) continue;
    next.s[outer] = strip.s[inner] + (rightward ? length : -length) * profile.unit_length;
    const int beginning = strip.on[line].obstacle;
    if (strip.parts[link].kind == Stretch::gap && is_plate(outer)) {
      const int plate = strip.on[outer].obstacle;
      next.parts[link].kind = Stretch::line;
      next.on[link] = next.on[link + 1] = chain::Seat{beginning};
      next.on[link].flat = plate;
      return next.successor();
    }
    if (strip.is_line(link) && strip.on[link].flat >= 0 && strip.on[line].flat < 0) {
      next.parts[link].kind = Stretch::gap;
      next.on[inner] = chain::Seat{beginning};
      next.on[outer] = chain::Seat{strip.on[link].flat};
      return next.successor();
    }
  }
  return std::nullopt;
}

}  // namespace windlass::equilibrium
