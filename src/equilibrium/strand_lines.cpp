#include <algorithm>
#include <cmath>
#include <numeric>

#include "line_touches.hpp"
#include "strand_successors.hpp"
#include "windlass/chain/self_distance.hpp"

/// The touches that a line between strands consists of (PHYSICS, "Lines between turns"): how many, and where.
namespace windlass::equilibrium {

namespace {

using chain::StrandLine;
using chain::Strands;
using chain::Stretch;
using chain::Topology;

/// What a line is divided by: p^¼ of the pressure p between the strands, for between touches h apart they are nearer by
/// ph⁴/192B. At the places of the touches and the line's ends, of its length.
struct Monitor {
  std::vector<double> part, value;
  double links = 0.0;  ///< that make them nearer by a quarter of what is carried

  double cumulative(std::size_t k) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < k; ++i) sum += 0.5 * (value[i] + value[i + 1]) * (part[i + 1] - part[i]);
    return sum;
  }
  /// Where a share of the whole ends.
  double place(double share) const {
    const double goal = share * cumulative(part.size() - 1);
    std::size_t k = 1;
    while (k + 1 < part.size() && cumulative(k) < goal) ++k;
    const double begin = cumulative(k - 1), end = cumulative(k);
    return part[k - 1] + (part[k] - part[k - 1]) * (goal - begin) / (end - begin);
  }
};

Monitor monitor_of(const chain::Profile& profile, const StrandLine& line, const Strip& strip) {
  constexpr double quarter = 0.25,
                   least = 1e-4;  // of the largest pressure, so that touches are nowhere too far apart
  const std::vector<int>& touches = line.first;
  const double begin = strip.s[touches.front()], length = strip.s[touches.back()] - begin;
  Monitor out;
  std::vector<double> pressure;
  for (std::size_t k = 1; k + 1 < touches.size(); ++k) {
    const double span = 0.5 * (strip.s[touches[k + 1]] - strip.s[touches[k - 1]]);
    out.part.push_back((strip.s[touches[k]] - begin) / length);
    pressure.push_back(std::max(profile.contact_at(touches[k])->force, 0.0) / span);
  }
  const double most = pressure.empty() ? 0.0 : *std::max_element(pressure.begin(), pressure.end());
  for (const double p : pressure) out.value.push_back(most > 0.0 ? std::pow(p + least * most, 0.25) : 1.0);
  out.part.insert(out.part.begin(), 0.0), out.part.push_back(1.0);
  const double at_begin = out.value.empty() ? 1.0 : out.value.front(),
               at_end = out.value.empty() ? 1.0 : out.value.back();
  out.value.insert(out.value.begin(), at_begin), out.value.push_back(at_end);
  const double unit =
      std::pow(192.0 * profile.material.bending_stiffness * quarter * carried_between_strands, 0.25);
  if (most > 0.0) out.links = out.cumulative(out.part.size() - 1) * length / unit;
  return out;
}

/// Places of the touches inside a line of so many links. @param own_image  symmetric
std::vector<double> divided(const Monitor& monitor, int links, bool own_image) {
  std::vector<double> out;
  for (int k = 1; k < links; ++k) out.push_back(monitor.place(static_cast<double>(k) / links));
  if (!own_image) return out;
  const std::vector<double> as_found = out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = 0.5 * (as_found[k] + 1.0 - as_found[out.size() - 1 - k]);
  return out;
}

/// The line with so many links, what is no touch of it left where it is.
Successor laid_anew(const StrandLine& line, Strip strip, const Monitor& monitor, int links) {
  const bool own_image = line.own_image();
  const std::vector<double> parts = divided(monitor, links, own_image);
  const int fresh = new_strand(strip);
  const auto lay = [&](std::vector<int> touches, bool of_second) {
    const bool reversed = of_second && line.image;  // an image runs the other way
    if (reversed) std::reverse(touches.begin(), touches.end());
    const double begin = strip.s[touches.front()], length = strip.s[touches.back()] - begin;
    const int mark = strip.on[touches.front()].line;
    for (std::size_t k = touches.size() - 1; k-- > 1;) {
      const int j = touches[k];
      strip.merge(j - 1, j, joined(strip.parts[j - 1].kind, strip.parts[j].kind));
    }
    for (int k = links - 1; k > 0; --k) {
      const int number = own_image ? std::min(k, links - k) : reversed ? links - k : k;
      const bool image = own_image ? 2 * k > links : reversed;
      const double part = reversed ? 1.0 - parts[links - 1 - k] : parts[k - 1];
      add_touch(strip, begin + length * part, {0, image ? -(fresh + number) : fresh + number, part, mark});
    }
  };
  // What is cut first must not move what follows.
  if (own_image) {
    lay(line.first, false);
  } else if (line.first.front() < line.second.front()) {
    lay(line.second, true);
    lay(line.first, false);
  } else {
    lay(line.first, false);
    lay(line.second, true);
  }
  measure_parts(strip);
  return strip.successor();
}

/// Marks touches, those of one strand and those of the other, as of one line; 0: of none.
void mark_line(Strip& strip, const std::vector<int>& first, const std::vector<int>& second, bool own_image,
               int line) {
  for (const int j : first) strip.on[j].line = line;
  if (!own_image)
    for (const int j : second) strip.on[j].line = -line;
}

/// A line that others have become: its mark, and whether it is one between a strand and its own image.
struct United {
  int line;
  bool own_image;
};

/// Touches on both sides of what faces each other, of one line now: what ended a line is inside one.
United unite(const Strands& strands, const Strands::Facing& here, Strip& strip) {
  std::vector<int> first = {here.begin, here.end}, second = {here.other_begin, here.other_end};
  bool own_image = here.begin == here.other_begin;
  for (const int end : {here.begin, here.end, here.other_begin, here.other_end}) {
    if (strands.line_of(end) < 0) continue;
    const StrandLine& line = strands.lines()[strands.line_of(end)];
    own_image = own_image || line.own_image();
    if (strip.on[end].line == 0)  // on obstacles touches next to each other are a line without a mark
      mark_line(strip, line.first, line.second, line.own_image(), new_strand(strip));
  }
  const int line = new_strand(strip);
  const auto gather = [&](std::vector<int>& side) {
    for (const int end : std::vector<int>(side)) {
      const int old = strip.on[end].line;
      if (old == 0) continue;
      strip.on[end].part = 0.5;
      for (int j = 0; j < static_cast<int>(strip.on.size()); ++j)
        if (strip.on[j].line == old) side.push_back(j);
    }
  };
  gather(first);
  gather(second);
  if (own_image) first.insert(first.end(), second.begin(), second.end());
  mark_line(strip, first, second, own_image, line);
  return {line, own_image};
}

}  // namespace

void measure_parts(Strip& strip) {
  constexpr double inside = 1e-6;  // at a place that it shares with an end
  const Topology topology = strip.successor().topology;
  const Strands strands(topology);
  const int count = static_cast<int>(strip.s.size());
  for (int j = 1; j + 1 < count; ++j) {
    chain::Seat& seat = strip.on[j];
    if (!strands.inside_line(j)) {
      seat.part = 0.0;  // was inside one that ends here now
      continue;
    }
    if (strands.located(j)) continue;
    const auto [first, last] = strands.between(j);
    const double begin = strip.s[first], length = strip.s[last] - begin;
    seat.part = std::clamp((strip.s[j] - begin) / length, inside, 1.0 - inside);
  }
}

std::optional<Successor> line_with_next(int joint, const chain::Profile& profile, const Topology& topology,
                                        Strip strip) {
  const Strands strands(topology);
  const auto overlaps = [&](int end) {
    return std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const chain::Contact& c) {
      return c.joint == end && c.coupling >= 0 && c.gap_curvature < 0.0;
    });
  };
  for (const int link : {joint - 1, joint})
    for (const Strands::Facing& f : strands.facing(std::max(link, 0))) {
      const bool joins = strands.line_of(f.begin) >= 0 || strands.line_of(f.end) >= 0;  // see line_joins()
      if (f.line >= 0 || joins || !overlaps(f.begin) || !overlaps(f.end)) continue;
      mark_line(strip, {f.begin, f.end}, {f.other_begin, f.other_end}, f.begin == f.other_begin,
                new_strand(strip));
      return strip.successor();
    }
  return std::nullopt;
}

std::optional<Successor> line_joins(int joint, const chain::Profile& profile, const Topology& topology,
                                    Strip strip) {
  constexpr double near = 0.1;
  const Strands strands(topology);
  for (const int link : {joint - 1, joint})
    for (const Strands::Facing& f : strands.facing(std::max(link, 0))) {
      const bool beside = f.begin == joint || f.end == joint,
                 line = strands.line_of(f.begin + f.end - joint) >= 0;
      if (f.line >= 0 || !beside || !line || strip.s[f.end] - strip.s[f.begin] > near * profile.unit_length)
        continue;
      unite(strands, f, strip);
      measure_parts(strip);
      return with_touches(skeleton_of(strip).strip.successor(), profile, topology);
    }
  return std::nullopt;
}

std::optional<Successor> gap_closes(int link, const chain::Profile& profile, const Topology& topology,
                                    Strip strip) {
  const Strands strands(topology);
  for (const Strands::Facing& f : strands.facing(link)) {
    if (f.line >= 0 || strands.line_of(f.begin) < 0 || strands.line_of(f.end) < 0) continue;
    unite(strands, f, strip);
    measure_parts(strip);
    return with_touches(skeleton_of(strip).strip.successor(), profile, topology);
  }
  return std::nullopt;
}

std::optional<Successor> line_of_three(int joint, const chain::Profile& profile, const Topology& topology,
                                       Strip strip) {
  constexpr double near = 0.2;
  const Strands strands(topology);
  const int last = static_cast<int>(strip.s.size()) - 1;
  if (strands.partner(joint) != joint || strands.line_of(joint) >= 0 || joint < 1 || joint >= last ||
      strands.partner(joint - 1) != joint + 1 ||
      strip.s[joint + 1] - strip.s[joint - 1] > near * profile.unit_length)
    return std::nullopt;
  mark_line(strip, {joint - 1, joint, joint + 1}, {}, true, new_strand(strip));
  strip.on[joint].part = 0.5;
  measure_parts(strip);
  return strip.successor();
}

bool next_to_line(const ContactEvent& event, const Topology& topology) {
  const Strands strands(topology);
  const Strands::Facing* f = strands.facing(event.place, event.other, event.mirrored);
  return f && (strands.line_of(f->begin) >= 0 || strands.line_of(f->end) >= 0);
}

std::optional<Successor> line_closes(const ContactEvent& event, const Topology& topology, Strip strip) {
  const Strands strands(topology);
  const Strands::Facing* f = strands.facing(event.place, event.other, event.mirrored);
  if (!f) return std::nullopt;
  const auto [line, own_image] = unite(strands, *f, strip);
  add_pair(strip, event.s, event.s_other, event.mirrored, own_image, {0, line, 0.5, line});
  measure_parts(strip);
  return strip.successor();
}

std::vector<Successor> line_passes(int link, bool by_strand, const chain::Profile& profile,
                                   const Topology& topology, const Strip& strip) {
  const Strands strands(topology);
  const auto ends_line = [&](int joint) {
    const bool marked = strip.on[joint].line != 0 || (by_strand && strands.line_of(joint) >= 0);
    return marked && !strands.inside_line(joint);
  };
  std::vector<Successor> out;
  for (const auto& [end, edge] : {std::pair(link, link + 1), std::pair(link + 1, link)}) {
    const bool pressed = strip.on[edge].strand != 0;
    if (edge == 0 || edge + 1 == static_cast<int>(strip.s.size())) continue;  // the mid-point, the rod's end
    const bool same_line = pressed && strands.line_of(edge) == strands.line_of(end);
    if (!ends_line(end) || pressed != by_strand || same_line) continue;
    const StrandLine& line = strands.lines()[strands.line_of(end)];
    const int other = partner(strip, end);
    const double way = edge < end ? -1.0 : 1.0;
    for (const double length : {0.01, 0.005, 0.02}) {
      const double s = strip.s[edge] + way * length * profile.unit_length;
      const double met = foot(profile, s, strip.s[other] + (line.image ? -way : way) * length, line.image);
      Strip longer = strip;
      // Marked, for what presses on it stands between touches next to each other.
      if (strip.on[end].line == 0)
        mark_line(longer, line.first, line.second, line.own_image(), new_strand(strip));
      longer.on[end].part = longer.on[other].part = 0.5;
      add_pair(longer, s, met, line.image, line.own_image(),
               {0, new_strand(longer), 0.0, longer.on[end].line});
      out.push_back(with_touches(skeleton_of(longer).strip.successor(), profile, topology));
    }
  }
  return out;
}

std::optional<Successor> line_extends(const ContactEvent& event, const Topology& topology, Strip strip) {
  constexpr double beside = 0.25;  // of what is between the line and the next touch
  const Strands strands(topology);
  const Strands::Facing* f = strands.facing(event.place, event.other, event.mirrored);
  if (!f || f->line >= 0) return std::nullopt;
  const double length = strip.s[f->end] - strip.s[f->begin];
  for (const int end : {f->begin, f->end}) {
    const int line = strip.on[end].line;
    if (line == 0 || std::abs(event.s - strip.s[end]) > beside * length) continue;
    const bool own_image = strands.lines()[strands.line_of(end)].own_image();
    strip.on[end].part = strip.on[partner(strip, end)].part = 0.5;
    add_pair(strip, event.s, event.s_other, event.mirrored, own_image, {0, new_strand(strip), 0.0, line});
    measure_parts(strip);
    return strip.successor();
  }
  return std::nullopt;
}

std::optional<Successor> line_filled(const ContactEvent& event, const chain::Profile& profile,
                                     const Topology& topology, Strip strip) {
  const Strands strands(topology);
  const Strands::Facing* here = strands.facing(event.place, event.other, event.mirrored);
  if (!here || here->line < 0) return std::nullopt;
  constexpr double soon = 0.125;  // of what is carried: these would follow
  int strand = new_strand(strip);
  for (const chain::Approach& near : chain::approaches(profile, topology)) {
    const Strands::Facing* f = strands.facing(near.link, near.other, near.mirrored);
    if (!f || f->line != here->line) continue;
    if (near.distance - 2.0 * profile.radius > -soon * carried_between_strands) continue;
    add_pair(strip, near.s, near.s_other, near.mirrored, strands.lines()[f->line].own_image(),
             {0, strand++, 0.5, topology.seat(f->begin).line});
  }
  measure_parts(strip);
  return strip.successor();
}

namespace {

/// The same strip with the touches of its lines laid anew, more of them than there are.
Successor with_more_touches(const chain::Profile& profile, const Topology& topology, const Strip& strip) {
  constexpr double more = 1.1;
  constexpr int most = 20;
  const Successor skeleton = skeleton_of(strip).strip.successor();
  Successor out;
  double finer = 1.0;
  for (int k = 0; k < most && out.s.size() <= strip.s.size(); ++k, finer *= more)
    out = with_touches(skeleton, profile, topology, finer);
  return out;
}

Successor with_more_touches(const chain::Profile& profile, const StrandLine& line, const Strip& strip) {
  constexpr int few = 4;  // tell little of the pressure
  const Monitor monitor = monitor_of(profile, line, strip);
  const int links = line.links();
  const int enough = links < few ? 2 * links : static_cast<int>(std::ceil(monitor.links));
  return laid_anew(line, strip, monitor, std::max(enough, links + 1));
}

}  // namespace

std::optional<Successor> line_with_fewer_touches(const chain::Profile& profile, const Topology& topology,
                                                 int link, const Strip& strip) {
  const Strands strands(topology);
  const int which = strands.line_of(link);
  if (which < 0 || which != strands.line_of(link + 1)) return std::nullopt;
  const StrandLine& line = strands.lines()[which];
  if (line.links() < 2) return std::nullopt;
  if (!line.on_obstacles) {
    const Successor skeleton = skeleton_of(strip).strip.successor();
    constexpr double fewer = 0.7, fewest = 0.01;
    Successor out = skeleton;
    for (double finer = 1.0; finer > fewest; finer *= fewer)
      if (out = with_touches(skeleton, profile, topology, finer); out.s.size() < strip.s.size()) return out;
    return skeleton;
  }
  const Monitor monitor = monitor_of(profile, line, strip);
  return laid_anew(line, strip, monitor,
                   std::clamp(static_cast<int>(std::ceil(monitor.links)), 1, line.links() - 1));
}

std::optional<Successor> line_with_more_touches(const ContactEvent& event, const chain::Profile& profile,
                                                const Topology& topology, const Strip& strip) {
  const Strands strands(topology);
  const Strands::Facing* here = strands.facing(event.place, event.other, event.mirrored);
  if (!here || here->line < 0) return std::nullopt;
  const StrandLine& line = strands.lines()[here->line];
  return line.on_obstacles ? with_more_touches(profile, line, strip)
                           : with_more_touches(profile, topology, strip);
}

Successor lines_with_denser_touches(const chain::Profile& profile, const Topology& topology, Strip strip,
                                    double finer) {
  const Strands strands(topology);
  for (const StrandLine& line : strands.lines())
    if (strip.on[line.first.front()].line == 0)  // on obstacles
      mark_line(strip, line.first, line.second, line.own_image(), new_strand(strip));
  return with_touches(skeleton_of(strip).strip.successor(), profile, topology, finer);
}

}  // namespace windlass::equilibrium
