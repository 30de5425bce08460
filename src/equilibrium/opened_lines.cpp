#include <algorithm>
#include <cmath>

#include "line_touches.hpp"
#include "strand_line_events.hpp"
#include "strand_successors.hpp"

/// Where lines between strands open, and what is left of them.
namespace windlass::equilibrium {

using chain::StrandLine;
using chain::Strands;
using chain::Topology;

void hold_at(const std::vector<double>& places, Successor& out) {
  for (int j = 0; j < static_cast<int>(out.s.size()); ++j)
    if (std::find(places.begin(), places.end(), out.s[j]) != places.end() &&
        (out.held.empty() || out.s[out.held.back()] != out.s[j]))
      out.held.push_back(j);
}

std::optional<Successor> line_opens(int joint, const Topology& topology, Strip strip) {
  const Strands strands(topology);
  const int which = strands.line_of(joint);
  if (which < 0 || strip.on[joint].line == 0) return std::nullopt;
  const StrandLine& line = strands.lines()[which];
  const bool own_image = line.own_image();
  const int last = line.links();
  int at = 0;
  while (line.first[at] != joint && line.second[at] != joint) ++at;
  const int from = own_image ? std::min(at, last - at) : at, to = own_image ? last - from : at;
  const int old = std::abs(strip.on[joint].line), fresh = new_strand(strip);
  // What is left on either side; of a line between a strand and its image that is the same on both, and another in the middle.
  const auto mark = [&](int begin, int end, int number, bool whole) {
    const bool alone = end - begin < 1 && whole;
    for (int k = std::max(begin, 0); k <= end; ++k)
      for (const bool second : {false, true}) {
        if (second && own_image) continue;
        chain::Seat& seat = strip.on[second ? line.second[k] : line.first[k]];
        seat.line = alone ? 0 : second ? -number : number;
        if (k == begin || k == end) seat.part = 0.0;
      }
  };
  mark(0, from - 1, old, !own_image || from == 1);
  mark(to + 1, last, own_image ? old : fresh, !own_image || from == 1);
  if (own_image) mark(from + 1, to - 1, fresh, true);
  take_out(joint, strip);
  measure_parts(strip);
  return strip.successor();
}

namespace {

/// Marks what is left of a line outside of what has opened, between two of its touches, as lines or touches of their own. Of a line
/// with the own image as much opens on the other side, or all between.
Strip open_between(const StrandLine& line, int low, int high, Strip strip) {
  const int last = line.links();
  const bool own_image = line.own_image(), through = own_image && high > last - high;
  const int fresh = new_strand(strip), old = strip.on[line.first.front()].line;
  const auto mark = [&](int begin, int end, int number, int of_second) {
    for (int k = begin; k <= end; ++k) {
      chain::Seat &one = strip.on[line.first[k]], &two = strip.on[line.second[k]];
      if (k == begin || k == end) one.part = two.part = 0.0;
      one.line = begin == end ? 0 : number;
      if (!own_image) two.line = begin == end ? 0 : of_second;
    }
  };
  mark(0, low, old, -old);
  if (!own_image) {
    mark(high, last, fresh, -fresh);
    return strip;
  }
  if (!through) mark(high, last - high, fresh, fresh);
  mark(last - low, last, -old, old);
  return strip;
}

/// The touches of a line next to what a suction has opened. @param wider  than the linear pressure says, as a factor
struct Edges {
  int low, high;
};
Edges edges_of(const Suction& pull, const StrandLine& line, const Strip& strip, double wider) {
  constexpr double beside = 5.0 / 3.0;
  const int last = line.links();
  const double begin = strip.s[line.first.front()], end = strip.s[line.first.back()];
  const double width = wider * pull.width(), middle = 0.5 * (pull.begin + pull.end);
  double from = middle - 0.5 * std::sqrt(5.0) * width, to = middle + 0.5 * std::sqrt(5.0) * width;
  if (pull.first == 1) from = begin, to = begin + beside * width;
  if (pull.last == last - 1) from = pull.first == 1 ? begin : end - beside * width, to = end;
  Edges out{0, last};
  while (out.low < last && strip.s[line.first[out.low + 1]] <= from) ++out.low;
  while (out.high > 0 && strip.s[line.first[out.high - 1]] >= to) --out.high;
  return out;
}

}  // namespace

std::vector<Successor> line_opens_by_suction(int joint, const chain::Profile& profile,
                                             const Topology& topology, const Strip& strip) {
  constexpr int several = 3;  // fewer open one by one
  const Strands strands(topology);
  const int which = strands.line_of(joint);
  if (which < 0 || strip.on[joint].line == 0) return {};
  const StrandLine& line = strands.lines()[which];
  const bool of_first = std::find(line.first.begin(), line.first.end(), joint) != line.first.end();
  Suction pull = suction_about(profile, strands, of_first ? joint : strands.partner(joint));
  if (pull.last - pull.first + 1 < several) return {};
  if (line.own_image() && pull.first + pull.last > line.links())  // the same on the side that comes first
    pull = suction_about(profile, strands, line.first[line.links() - pull.first]);
  std::vector<Successor> out;
  for (const double wider : {1.0, 1.2, 0.85}) {
    const Edges edges = edges_of(pull, line, strip, wider);
    if (edges.high - edges.low < 2) continue;
    const Strip open = open_between(line, edges.low, edges.high, strip);
    out.push_back(with_touches(skeleton_of(open).strip.successor(), profile, topology));
    hold_at({strip.s[line.first[edges.low]], strip.s[line.second[edges.low]], strip.s[line.first[edges.high]],
             strip.s[line.second[edges.high]]},
            out.back());
  }
  return out;
}

std::vector<Successor> line_opens_about(int middle, int other, const chain::Profile& profile,
                                        const Topology& topology, const Strip& strip) {
  const Strands strands(topology);
  const StrandLine& line = strands.lines()[strands.line_of(middle)];
  std::vector<Successor> out;
  for (const double clear : {0.015, 0.01, 0.02}) {
    const double apart = std::abs(strip.s[other] - strip.s[middle]) + clear * profile.unit_length;
    const auto is_clear = [&](int j) { return strip.s[j] < strip.s[middle] - apart; };
    const auto inner = std::find_if_not(line.first.begin(), line.first.end(), is_clear);
    if (inner - line.first.begin() < 2) continue;
    const int low = *(inner - 1), high = strands.partner(low);
    Strip open = strip;
    for (const int joint : {low, high}) open.on[joint].part = 0.0;
    for (const int joint : line.first)
      if (strip.s[joint] >= strip.s[high]) open.on[joint].line = -open.on[joint].line;
    out.push_back(with_touches(skeleton_of(open).strip.successor(), profile, topology));
    hold_at({strip.s[low], strip.s[high]}, out.back());
  }
  return out;
}

}  // namespace windlass::equilibrium
