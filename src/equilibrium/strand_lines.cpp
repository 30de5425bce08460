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
    const auto touch = std::find_if(profile.contacts.begin(), profile.contacts.end(),
                                    [&](const chain::Contact& c) { return c.joint == j; });
    out.part.push_back((strip.s[j] - begin) / length);
    pressure.push_back(std::max(touch->force, 0.0) / (0.5 * (strip.s[j + 1] - strip.s[j - 1])));
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

Successor laid_anew(const Topology& topology, Strip strip, int link, const Monitor& monitor, int links) {
  const Topology::Run runs[] = {topology.run(link), topology.run(topology.beside(link))};
  const bool own_image = runs[0].first == runs[1].first;
  const bool mirrored = own_image || strip.on[runs[0].first].strand != strip.on[runs[1].first].strand;
  const std::vector<double> parts = divided(monitor, links, own_image);
  const int fresh = new_strand(strip);
  const auto lay = [&](const Topology::Run& run, bool image) {  // an image runs the other way
    const double begin = strip.s[run.first], length = strip.s[run.first + run.count] - begin;
    const int obstacle = strip.on[run.first].obstacle;
    const Stretch kind = strip.parts[run.first].kind;
    strip.merge(run.first, run.first + run.count - 1, kind);
    for (int k = links - 1; k > 0; --k) {
      const int number = own_image ? std::min(k, links - k) : image ? links - k : k;
      const bool second = own_image ? 2 * k > links : image;
      const double part = image ? 1.0 - parts[links - 1 - k] : parts[k - 1];
      const int strand = fresh + number;
      strip.split(run.first, begin + length * part, kind, kind,
                  chain::Seat{obstacle, second ? -strand : strand, part});
    }
  };
  const int late = runs[0].first < runs[1].first ? 1 : 0;  // what is cut first must not move what follows
  lay(runs[late], !own_image && mirrored && late == 1);
  if (!own_image) lay(runs[1 - late], mirrored && late == 0);
  return strip.successor();
}

}  // namespace

namespace {

/// Places of the touches inside lines as parts of these, where their ends have changed.
void measure_parts(Strip& strip) {
  const auto inside = [&](int joint) { return strip.on[joint].part > 0.0; };
  const int last = static_cast<int>(strip.s.size()) - 1;
  for (int j = 1; j < last; ++j) {
    if (!inside(j)) continue;
    int begin = j, end = j;
    while (begin > 0 && inside(begin)) --begin;
    while (end < last && inside(end)) ++end;
    strip.on[j].part = (strip.s[j] - strip.s[begin]) / (strip.s[end] - strip.s[begin]);
  }
}

}  // namespace

bool lies_on_obstacles(const Topology& topology, int link) {
  return topology.stretches[link] == Stretch::line && topology.stretches[topology.facing(link).link] == Stretch::line;
}

std::optional<Successor> line_opens(int joint, Strip strip) {
  if (strip.on[joint].part == 0.0) return std::nullopt;
  const int other = partner(strip, joint);
  for (const int j : {std::max(joint, other), std::min(joint, other)}) {
    strip.merge(j - 1, j, joined(strip.parts[j - 1].kind, strip.parts[j].kind));
    if (joint == other) break;
  }
  measure_parts(strip);
  return strip.successor();
}

std::optional<Successor> line_filled(const ContactEvent& event, const chain::Profile& profile,
                                     const Topology& topology, Strip strip) {
  const Topology::Facing facing = topology.facing(event.place);
  if (facing.link != event.other || facing.image != event.mirrored) return std::nullopt;
  const Topology::Run run = topology.run(event.place);
  int strand = new_strand(strip);
  for (const chain::Approach& near : chain::approaches(profile, topology)) {
    const bool here = near.link == event.place || (near.link >= run.first && near.link < run.first + run.count) || (near.other >= run.first && near.other < run.first + run.count);
    const Topology::Facing faced = topology.facing(near.link);
    if (!here || faced.link != near.other || faced.image != near.mirrored) continue;
    if (near.distance - 2.0 * profile.radius > -carried_between_strands) continue;
    const bool own_image = near.mirrored && near.link == near.other && std::abs(near.s - near.s_other) < 1e-6;
    const auto cut = [&](double at, int mark) {
      const int i = strip.part_at(at);
      const Stretch kind = strip.parts[i].kind;
      strip.split(i, at, kind, kind, chain::Seat{strip.on[i].obstacle, mark, 0.5});
    };
    cut(near.s, strand);
    if (!own_image) cut(near.s_other, near.mirrored ? -strand : strand);
    ++strand;
  }
  measure_parts(strip);
  return strip.successor();
}

std::optional<Successor> line_with_fewer_touches(const chain::Profile& profile, const Topology& topology,
                                                 int link, const Strip& strip) {
  const int links = topology.run(link).count;
  if (links < 2 || !lies_on_obstacles(topology, link)) return std::nullopt;
  const Monitor monitor = monitor_of(profile, topology.run(link), strip);
  return laid_anew(topology, strip, link, monitor,
                   std::clamp(static_cast<int>(std::ceil(monitor.links)), 1, links - 1));
}

std::optional<Successor> line_with_more_touches(const chain::Profile& profile, const Topology& topology,
                                                int link, const Strip& strip) {
  const int links = topology.run(link).count;
  if (links == 0 || !lies_on_obstacles(topology, link)) return std::nullopt;
  constexpr int few = 4;  // tell little of the pressure
  const Monitor monitor = monitor_of(profile, topology.run(link), strip);
  const int enough = links < few ? 2 * links : static_cast<int>(std::ceil(monitor.links));
  return laid_anew(topology, strip, link, monitor, std::max(enough, links + 1));
}

}  // namespace windlass::equilibrium
