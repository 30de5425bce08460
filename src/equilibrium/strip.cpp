#include "strip.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::equilibrium {

using chain::Stretch;

Strip::Strip(const chain::Topology& topology, const std::vector<double>& places)
    : s(places),
      half(topology.half),
      mid_touch(topology.mid_touch),
      marker(static_cast<int>(topology.left.size())) {
  for (const Stretch kind : chain::stretches(topology)) {
    const int link = static_cast<int>(parts.size());
    parts.push_back({kind, link, false, topology.micro_gaps_of(link)});
  }
}

Successor Strip::successor() const {
  Successor out;
  out.s = s;
  std::vector<Stretch> kinds;
  std::vector<chain::MicroGaps> gaps;
  for (const Part& part : parts) {
    if (part.fresh) out.opened.push_back(static_cast<int>(kinds.size()));
    kinds.push_back(part.kind);
    gaps.push_back(part.kind == Stretch::line ? part.gaps : chain::MicroGaps{});
    out.source.push_back(part.source);
  }
  out.passes_mid = passes_mid;
  out.topology.half = half;
  out.topology.mid_touch = mid_touch;
  out.topology.right.assign(kinds.begin() + marker, kinds.end());
  out.topology.left.assign(kinds.rend() - marker, kinds.rend());
  out.topology.set_micro_gaps(std::move(gaps));
  out.nothing_left = !out.topology.contact();
  return out;
}

bool Strip::astride(Stretch kind) const {
  return parts[marker].kind == kind && (half || parts[marker - 1].kind == kind);
}

void Strip::erase(int i, int bound) {
  parts.erase(parts.begin() + i);
  s.erase(s.begin() + bound);
  if (!half && bound < marker) --marker;
}

void Strip::merge(int first, int last, Stretch kind) {
  chain::MicroGaps gaps{parts[first].gaps.begin, parts[last].gaps.end, 0};
  for (int i = first; i <= last; ++i) gaps.inside += parts[i].gaps.inside;
  for (int i = last; i > first; --i) erase(i, i);
  parts[first].kind = kind;
  parts[first].gaps = gaps;
}

void Strip::split(int i, double at, Stretch left, Stretch right) {
  const Part old = parts[i];
  parts[i].kind = left;
  parts[i].gaps.end = false;
  parts.insert(parts.begin() + i + 1, {right, old.source, false, {false, old.gaps.end, 0}});
  s.insert(s.begin() + i + 1, at);
  if (!half && marker > i) ++marker;
}

bool Strip::collapse(int i) {
  const bool starts = starts_at_mid(i), ends = ends_at_mid(i);
  if (!mid_touch && astride(parts[i].kind) && (starts || ends)) {
    const int other = starts ? i - 1 : i + 1;
    const bool one = !half && one_side_ends(s[i + 1] - s[i], s[other + 1] - s[other]);
    return one ? pass_mid(i) : collapse_about_mid();
  }
  if (mid_touch && (starts || ends)) {  // a touch meets the one at the mid-point
    erase(i, starts ? i + 1 : i);
    mid_touch = !astride(Stretch::line);
    return true;
  }
  if (i == 0 || i + 1 == static_cast<int>(parts.size())) return false;
  const bool line_before = parts[i - 1].kind == Stretch::line,
             line_after = parts[i + 1].kind == Stretch::line;
  if (line_before && line_after) {
    merge(i - 1, i + 1, Stretch::line);
    return true;
  }
  if (parts[i].kind == Stretch::line ||
      (!line_before && !line_after))  // two edges or two touches meet: one touch
    s[i] = 0.5 * (s[i] + s[i + 1]);
  else if (line_before)  // line – gap – touch: the touch joins the line
    s[i] = s[i + 1];
  erase(i, i + 1);
  return true;
}

bool Strip::pass_mid(int i) {
  const bool on_right = i == marker;
  const int next = on_right ? i + 1 : i - 1;
  if (parts[next].kind == Stretch::tail) return false;
  parts[i].kind = parts[next].kind;
  parts[i].source = parts[next].source;
  const double bound = std::max(std::abs(s[on_right ? i + 1 : i]), past_mid);
  s[i] = on_right ? -bound : 0.0;
  s[i + 1] = on_right ? 0.0 : bound;
  marker = on_right ? i + 1 : i;
  passes_mid = true;
  return true;
}

bool Strip::collapse_about_mid() {
  erase(marker, marker + 1);
  if (!half) erase(marker - 1, marker - 1);
  const bool line_after = parts[marker].kind == Stretch::line;
  if (!half && line_after != (parts[marker - 1].kind == Stretch::line)) return false;
  mid_touch =
      !line_after;  // between lines a gap has closed; else a line, or a gap between touches, leaves one
  return true;
}

}  // namespace windlass::equilibrium
