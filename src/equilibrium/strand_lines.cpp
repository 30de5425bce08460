#include <algorithm>
#include <cmath>
#include <numeric>

#include "strand_successors.hpp"
#include "windlass/chain/self_distance.hpp"

/// The touches that a line between strands consists of (PHYSICS, "Lines between turns"): how many, and where.
namespace windlass::equilibrium {

namespace {

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

Monitor monitor_of(const chain::Profile& profile, const Topology::Run& run, const Strip& strip) {
  constexpr double quarter = 0.25,
                   least = 1e-4;  // of the largest pressure, so that touches are nowhere too far apart
  const int last = run.first + run.count;
  const double begin = strip.s[run.first], length = strip.s[last] - begin;
  Monitor out;
  std::vector<double> pressure;
  for (int j = run.first + 1; j < last; ++j) {
    if (strip.on[j].strand == 0) continue;  // an edge
    int before = j - 1, after = j + 1;
    while (strip.on[before].strand == 0) --before;
    while (strip.on[after].strand == 0) ++after;
    const auto touch = std::find_if(profile.contacts.begin(), profile.contacts.end(),
                                    [&](const chain::Contact& c) { return c.joint == j; });
    out.part.push_back((strip.s[j] - begin) / length);
    pressure.push_back(std::max(touch->force, 0.0) / (0.5 * (strip.s[after] - strip.s[before])));
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

/// The line that a link belongs to, of so many links, its edges on obstacles left where they are.
Successor laid_anew(const Topology& topology, Strip strip, int link, const Monitor& monitor, int links) {
  const Topology::Run runs[] = {topology.run(link), topology.run_facing(link)};
  const bool own_image = runs[0].first == runs[1].first;
  const bool mirrored = topology.facing(link)->image;
  const std::vector<double> parts = divided(monitor, links, own_image);
  const int fresh = new_strand(strip), line = strip.on[runs[0].first].line;
  const auto lay = [&](const Topology::Run& run, bool image) {  // an image runs the other way
    const double begin = strip.s[run.first], length = strip.s[run.first + run.count] - begin;
    for (int j = run.first + run.count - 1; j > run.first; --j)
      if (strip.on[j].strand != 0)
        strip.merge(j - 1, j, joined(strip.parts[j - 1].kind, strip.parts[j].kind));
    for (int k = links - 1; k > 0; --k) {
      const int number = own_image ? std::min(k, links - k) : image ? links - k : k;
      const bool second = own_image ? 2 * k > links : image;
      const double part = image ? 1.0 - parts[links - 1 - k] : parts[k - 1], at = begin + length * part;
      const int i = strip.part_at(at), strand = fresh + number;
      const Stretch kind = strip.parts[i].kind;
      const int obstacle = kind == Stretch::line ? strip.on[i].obstacle : 0;
      strip.split(i, at, kind, kind, chain::Seat{obstacle, second ? -strand : strand, part, line});
    }
  };
  const int late = runs[0].first < runs[1].first ? 1 : 0;  // what is cut first must not move what follows
  lay(runs[late], !own_image && mirrored && late == 1);
  if (!own_image) lay(runs[1 - late], mirrored && late == 0);
  return strip.successor();
}

/// Touches of a line in a topology: joints of the run, its ends too.
std::vector<int> touches_of(const Topology::Run& run, const Strip& strip) {
  std::vector<int> out;
  for (int j = run.first; j <= run.first + run.count; ++j)
    if (strip.on[j].strand != 0) out.push_back(j);
  return out;
}

}  // namespace

void measure_parts(Strip& strip) {
  const auto inside = [&](int joint) { return strip.on[joint].strand == 0 || strip.on[joint].part > 0.0; };
  const int last = static_cast<int>(strip.s.size()) - 1;
  for (int j = 1; j < last; ++j) {
    if (strip.on[j].part == 0.0) continue;
    int begin = j, end = j;
    while (begin > 0 && inside(begin)) --begin;
    while (end < last && inside(end)) ++end;
    strip.on[j].part = (strip.s[j] - strip.s[begin]) / (strip.s[end] - strip.s[begin]);
  }
}

std::optional<Successor> line_with_next(int joint, const chain::Profile& profile, const Topology& topology,
                                        Strip strip) {
  const auto overlaps = [&](int end) {
    return std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const chain::Contact& c) {
      return c.joint == end && c.coupling >= 0 && c.gap_curvature < 0.0;
    });
  };
  for (const int link : {joint - 1, joint}) {
    const auto faced = link < 0 ? std::nullopt : topology.facing(link);
    if (!faced) continue;
    const Topology::Interval here = *topology.between_touches(link);
    if (!overlaps(here.begin) || !overlaps(here.end)) continue;
    const int line = new_strand(strip);
    for (const int end : {here.begin, here.end, faced->interval.begin, faced->interval.end})
      strip.on[end].line = line;
    return strip.successor();
  }
  return std::nullopt;
}

namespace {

/// Touches that are of one line now: what ends a line among them is inside one. @returns its number
int unite_lines(const std::vector<int>& touches, Strip& strip) {
  const int line = new_strand(strip);
  std::vector<int> old;
  for (const int joint : touches) {
    chain::Seat& seat = strip.on[joint];
    if (seat.line != 0 && seat.line != line) old.push_back(seat.line), seat.part = 0.5;
    if (seat.line == 0) seat.line = line;
  }
  for (chain::Seat& seat : strip.on)
    if (std::find(old.begin(), old.end(), seat.line) != old.end()) seat.line = line;
  return line;
}

}  // namespace

std::optional<Successor> line_closes(const ContactEvent& event, const Topology& topology, Strip strip) {
  if (!topology.faces(event.place, event.other, event.mirrored)) return std::nullopt;
  const Topology::Interval here = *topology.between_touches(event.place),
                           there = topology.facing(event.place)->interval;
  const int line = unite_lines({here.begin, here.end, there.begin, there.end}, strip);
  const auto touch = [&](double at, int mark) {
    const int i = strip.part_at(at);
    strip.cut(i, at, {0, mark, 0.5, line});
  };
  constexpr double same = 1e-6;
  const bool own_image =
      event.mirrored && event.place == event.other && std::abs(event.s - event.s_other) < same;
  touch(event.s, line);
  if (!own_image) touch(event.s_other, event.mirrored ? -line : line);
  measure_parts(strip);
  return strip.successor();
}

std::optional<Successor> line_filled(const ContactEvent& event, const chain::Profile& profile,
                                     const Topology& topology, Strip strip) {
  if (!topology.along(event.place)) return std::nullopt;
  constexpr double soon = 0.125;  // of what is carried: these would follow
  const Topology::Run run = topology.run(event.place), facing = topology.run_facing(event.place);
  const auto inside = [](const Topology::Run& r, int link) {
    return link >= r.first && link < r.first + r.count;
  };
  const int line = strip.on[run.first].line;
  int strand = new_strand(strip);
  for (const chain::Approach& near : chain::approaches(profile, topology)) {
    if (!(inside(run, near.link) || inside(facing, near.link)) ||
        !topology.faces(near.link, near.other, near.mirrored))
      continue;
    if (near.distance - 2.0 * profile.radius > -soon * carried_between_strands) continue;
    const auto cut = [&](double at, int mark) {
      const int i = strip.part_at(at);
      const Stretch kind = strip.parts[i].kind;
      strip.split(i, at, kind, kind,
                  chain::Seat{kind == Stretch::line ? strip.on[i].obstacle : 0, mark, 0.5, line});
    };
    constexpr double same = 1e-6;
    const bool own_image = near.mirrored && near.link == near.other && std::abs(near.s - near.s_other) < same;
    cut(near.s, strand);
    if (!own_image) cut(near.s_other, near.mirrored ? -strand : strand);
    ++strand;
  }
  measure_parts(strip);
  return strip.successor();
}

namespace {

/// Does a line end without a force of its own, next to another touch of the two strands? Then hardly anything parts it from that.
/// @returns the link between, −1: none
int soft_end(const chain::Profile& profile, const Topology& topology, int link) {
  const auto force = [&](int joint) {
    return std::find_if(profile.contacts.begin(), profile.contacts.end(),
                        [&](const chain::Contact& c) { return c.joint == joint; })
        ->force;
  };
  for (const Topology::Run& run : {topology.run(link), topology.run_facing(link)}) {
    const int last = run.first + run.count;
    const Topology::Interval first_links = *topology.between_touches(run.first),
                             last_links = *topology.between_touches(last - 1);
    if (first_links == last_links) continue;  // nothing inside to compare with
    if (run.first > 0 && topology.facing(run.first - 1) && force(run.first) < 2.0 * force(first_links.end))
      return run.first - 1;
    if (last < static_cast<int>(topology.stretches.size()) && topology.facing(last) &&
        force(last) < 2.0 * force(last_links.begin))
      return last;
  }
  return -1;
}

}  // namespace

std::optional<Successor> line_goes_on(int link, const chain::Profile& profile, const Topology& topology,
                                      const Strip& strip) {
  const int gap = soft_end(profile, topology, link);
  if (gap < 0) return std::nullopt;
  Strip united = strip;
  const Topology::Interval here = *topology.between_touches(gap), there = topology.facing(gap)->interval;
  unite_lines({here.begin, here.end, there.begin, there.end}, united);
  measure_parts(united);
  const Successor marked = united.successor();
  return line_with_more_touches(profile, marked.topology, link, united);
}

std::optional<Successor> line_opens(int joint, const Topology& topology, Strip strip) {
  const int line = strip.on[joint].line, other = partner(strip, joint), fresh = new_strand(strip);
  if (line == 0) return std::nullopt;
  const Topology::Run before = topology.run(joint - 1), run = before.count > 0 ? before : topology.run(joint);
  const bool own_image = other >= run.first && other <= run.first + run.count;
  const int from = own_image ? std::min(joint, other) : joint,
            to = own_image ? std::max(joint, other) : joint;
  // What is left on either side; of a line between a strand and its image that is the same on both, and another in the middle.
  std::vector<int> low, high, middle;
  for (const int j : touches_of(run, strip)) {
    if (j < from) low.push_back(j);
    if (j > to) high.push_back(j);
    if (j > from && j < to) middle.push_back(j);
  }
  const auto mark = [&](const std::vector<int>& side, int number) {
    for (const int j : side)
      for (chain::Seat* seat : {&strip.on[j], &strip.on[partner(strip, j)]}) {
        seat->line = side.size() > 1 ? number : 0;
        if (j == side.front() || j == side.back()) seat->part = 0.0;
      }
  };
  mark(low, line);
  mark(high, own_image ? line : fresh);
  mark(middle, fresh);
  for (const int j : {std::max(joint, other), std::min(joint, other)}) {
    strip.merge(j - 1, j, joined(strip.parts[j - 1].kind, strip.parts[j].kind));
    if (joint == other) break;
  }
  measure_parts(strip);
  return strip.successor();
}

std::optional<Successor> line_with_fewer_touches(const chain::Profile& profile, const Topology& topology,
                                                 int link, const Strip& strip) {
  const int links = static_cast<int>(touches_of(topology.run(link), strip).size()) - 1;
  if (links < 2) return std::nullopt;
  const Monitor monitor = monitor_of(profile, topology.run(link), strip);
  return laid_anew(topology, strip, link, monitor,
                   std::clamp(static_cast<int>(std::ceil(monitor.links)), 1, links - 1));
}

std::optional<Successor> line_with_more_touches(const chain::Profile& profile, const Topology& topology,
                                                int link, const Strip& strip) {
  const int links = static_cast<int>(touches_of(topology.run(link), strip).size()) - 1;
  if (links == 0) return std::nullopt;
  constexpr int few = 4;  // tell little of the pressure
  const Monitor monitor = monitor_of(profile, topology.run(link), strip);
  const int enough = links < few ? 2 * links : static_cast<int>(std::ceil(monitor.links));
  return laid_anew(topology, strip, link, monitor, std::max(enough, links + 1));
}

}  // namespace windlass::equilibrium
