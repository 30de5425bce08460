#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// Free arcs left and right of what was lost become one: a tail if either is.
Stretch joined(Stretch a, Stretch b) {
  return a == Stretch::tail || b == Stretch::tail ? Stretch::tail : Stretch::gap;
}

/// Stretch of negative pressure round s; no length at the event itself.
std::pair<double, double> suction(const Piece& line, double s) {
  const auto edge = [&](Eigen::Index k, Eigen::Index next) {
    return line.s(k) + (line.s(next) - line.s(k)) * line.p(k) / (line.p(k) - line.p(next));
  };
  Eigen::Index k = 0;
  (line.s.array() - s).abs().minCoeff(&k);
  if (line.p(k) >= -1e-9) return {s, s};
  Eigen::Index first = k, last = k;
  const Eigen::Index end = line.s.size() - 1;
  while (first > 0 && line.p(first - 1) < 0.0) --first;
  while (last < end && line.p(last + 1) < 0.0) ++last;
  return {first > 0 ? edge(first, first - 1) : line.s(0), last < end ? edge(last, last + 1) : line.s(end)};
}

/// Lengths to try for a gap that opens where the pressure is negative over `width`. A beam held off by the pressure
/// p₀ + a x² needs √5 times that width for g = g' = g'' = 0 at its ends, one held at a touch 5/3 of it; at the event
/// itself the width is nothing, and the load gives way to any length: by its square inside, in proportion at an edge.
std::vector<double> gap_lengths(double width, double factor, double usual, double most) {
  std::vector<double> out;
  for (const double part : {1.0, 0.5, 2.0, 3.0})
    out.push_back(std::min(most, part * (width > 1e-6 ? factor * width : usual)));
  return out;
}

/// The same line with one gap more: no length and no arc yet.
Successor opened(const ContactEvent& event, Strip strip) {
  const int i = event.place;
  constexpr double at_edge = 1e-6,
                   at_mid = 1e-3;  // places of least values are known to half of a double's digits
  const bool begins = event.s - strip.s[i] < (strip.starts_at_mid(i) ? at_mid : at_edge);
  const bool ends = strip.s[i + 1] - event.s < (strip.ends_at_mid(i) ? at_mid : at_edge);
  chain::MicroGaps& gaps = strip.parts[i].gaps;
  gaps.begin |= begins;
  gaps.end |= ends;
  gaps.inside += !begins && !ends;
  if (!strip.half && begins && strip.starts_at_mid(i)) strip.parts[i - 1].gaps.end = true;
  if (!strip.half && ends && strip.ends_at_mid(i)) strip.parts[i + 1].gaps.begin = true;
  Successor out = strip.successor();
  out.same_chain = true;
  return out;
}

/// The line without the gap that has closed.
Successor closed(const ContactEvent& event, Strip strip, const Profile& profile, const Topology& topology,
                 const Scales& scales) {
  const int i = event.place;
  chain::MicroGaps& gaps = strip.parts[i].gaps;
  switch (shallowest(line_contact_of(profile.pieces[i], topology, i, scales)).where) {
    case MicroGap::Where::inside:
      --gaps.inside;
      break;
    case MicroGap::Where::begin:
      gaps.begin = false;
      if (!strip.half && strip.starts_at_mid(i)) strip.parts[i - 1].gaps.end = false;
      break;
    case MicroGap::Where::end:
      gaps.end = false;
      if (!strip.half && strip.ends_at_mid(i)) strip.parts[i + 1].gaps.begin = false;
      break;
  }
  Successor out = strip.successor();
  out.same_chain = true;
  return out;
}

/// An arc for the gap that needs one.
std::vector<Successor> with_arc(const ContactEvent& event, Strip strip, const Profile& profile,
                                const Topology& topology, const Scales& scales) {
  int i = event.place;
  const LineContact line = line_contact_of(profile.pieces[i], topology, i, scales);
  const MicroGap gap = tallest(line);
  chain::MicroGaps& all = strip.parts[i].gaps;
  int before = 0;
  for (const MicroGap& other : line.gaps) before += other.where == MicroGap::Where::inside && other.s < gap.s;
  const int after = all.inside - before - (gap.where == MicroGap::Where::inside);
  if (gap.where == MicroGap::Where::begin) all.begin = false;
  if (gap.where == MicroGap::Where::end) all.end = false;
  all.inside = before;
  const bool twin = !strip.half && ((gap.where == MicroGap::Where::begin && strip.starts_at_mid(i)) ||
                                    (gap.where == MicroGap::Where::end && strip.ends_at_mid(i)));
  if (twin) return {};
  if (gap.to < strip.s[i + 1]) {
    strip.split(i, gap.to, Stretch::line, Stretch::line);
    strip.parts[i + 1].gaps.inside = after;
  }
  const bool has_line_before = gap.from > strip.s[i];
  if (has_line_before) strip.split(i++, gap.from, Stretch::line, Stretch::line);
  if (!has_line_before) strip.parts[i].gaps = {};
  strip.parts[i].kind = Stretch::gap;
  strip.parts[i].fresh = true;
  Successor out = strip.successor();
  out.same_contacts = true;
  return {out};
}

/// A gap in a line contact gives up its arc.
std::optional<Successor> without_arc(int i, Strip strip) {
  const int last = static_cast<int>(strip.parts.size()) - 1;
  const bool before = i > 0 && strip.parts[i - 1].kind == Stretch::line;
  const bool after = i < last && strip.parts[i + 1].kind == Stretch::line;
  const bool mid = strip.half && strip.starts_at_mid(i);
  strip.merge(before ? i - 1 : i, after ? i + 1 : i, Stretch::line);
  chain::MicroGaps& gaps = strip.parts[before ? i - 1 : i].gaps;
  if (before && after) ++gaps.inside;
  if (before && !after) gaps.end = true;
  if (!before) gaps.begin = true;
  if (mid && strip.mid_touch) return std::nullopt;
  Successor out = strip.successor();
  out.same_contacts = true;
  return out;
}

std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip, const Piece& line,
                                      const Scales& scales) {
  constexpr double uniform = 1e-6;  // a flat line's pressure, to what its mesh leaves of it
  std::vector<Successor> out;
  const int i = event.place;
  const double begin = strip.s[i], end = strip.s[i + 1], length = end - begin;
  const bool starts_at_mid = strip.starts_at_mid(i), ends_at_mid = strip.ends_at_mid(i);
  const int twin = strip.half ? i : starts_at_mid ? i - 1 : ends_at_mid ? i + 1 : i;
  Strip open = strip;  // the whole line lifts at once, on both sides of a full chain's mid-point
  open.parts[i].kind = open.parts[twin].kind = Stretch::gap;
  if (line.p.maxCoeff() - line.p.minCoeff() < uniform * scales.pressure) return {open.successor()};
  out.push_back(opened(event, strip));
  const auto [low, high] = suction(line, event.s);
  const double width = high - low, near = 0.02 * length;
  const bool at_start = low<begin + near, at_end = high> end - near;
  const bool at_mid = (at_start && starts_at_mid) || (at_end && ends_at_mid);
  const auto cut = [&](Strip part, int link, double from, double to) {  // a gap [from, to] inside a link
    const bool before = from > part.s[link], after = to < part.s[link + 1];
    if (after) part.split(link, to, Stretch::gap, Stretch::line);
    if (before) part.split(link, from, Stretch::line, Stretch::gap);
    part.parts[link + before].fresh = true;
    return part;
  };
  if (at_mid) {
    for (const double size : gap_lengths(2.0 * width, std::sqrt(5.0), 0.3, 1.8 * length)) {
      const int right = ends_at_mid ? i + 1 : i;
      Strip inner = cut(strip, right, strip.s[right], strip.s[right] + 0.5 * size);
      if (twin != i) inner = cut(inner, right - 1, strip.s[right] - 0.5 * size, strip.s[right]);
      out.push_back(inner.successor());
    }
  } else if (at_start ||
             at_end) {  // the edge's point force stays: a touch, with a gap between it and the line
    for (const double size : gap_lengths(width, 5.0 / 3.0, 0.05, 0.9 * length))
      out.push_back(
          (at_end ? cut(strip, i, end - size, end) : cut(strip, i, begin, begin + size)).successor());
  } else {
    const double middle = 0.5 * (low + high), room = 1.8 * std::min(middle - begin, end - middle);
    for (const double size : gap_lengths(width, std::sqrt(5.0), 0.3, room))
      out.push_back(cut(strip, i, middle - 0.5 * size, middle + 0.5 * size).successor());
  }
  out.push_back(open.successor());
  return out;
}

/// A line that has this length or less at an event shrinks to nothing there.
bool vanishes(const Strip& strip, int link) {
  constexpr double vanished = 3.0 * least_length;  // one across the mid-point is seen when twice as long
  return link >= 0 && link < static_cast<int>(strip.parts.size()) &&
         strip.parts[link].kind == Stretch::line && std::abs(strip.s[link + 1] - strip.s[link]) < vanished;
}

std::vector<Successor> after_length(int link, const Strip& strip) {
  std::vector<Successor> out;
  // In long helices lines shrink to nothing together, at distances that differ by less than rounding.
  Strip together = strip;
  int count = 0;
  for (int i = static_cast<int>(strip.parts.size()); i-- > 0;) {
    if (strip.ends_at_mid(i) && vanishes(strip, i + 1)) continue;  // went with its twin across the mid-point
    if (i == link || vanishes(strip, i)) count += together.collapse(i);
  }
  if (count > 1) out.push_back(together.successor());
  Strip alone = strip;
  if (alone.collapse(link)) out.push_back(alone.successor());
  return out;
}

std::vector<Successor> after_force(const ContactEvent& event, Strip strip, const Profile& profile,
                                   const Topology& topology, const Scales& scales) {
  const int j = event.place;
  if (strip.mid_touch && j == strip.marker) {
    strip.mid_touch = false;
    return {strip.successor()};
  }
  const Stretch before = strip.parts[j - 1].kind, after = strip.parts[j].kind;
  if (before == Stretch::line || after == Stretch::line) return {};
  constexpr double lifted =
      1e-6;  // with the last force the rod leaves the cylinder, from mirror images at once
  strip.merge(j - 1, j, joined(before, after));
  Successor next = strip.successor();
  next.nothing_left |= chain::total_contact_force(profile, topology) < lifted * scales.force;
  return {next};
}

/// A touch replaced by a stretch of a given length.
Successor widened(const Strip& strip, int j, Stretch between, double length) {
  Strip wide = strip;
  const double begin = strip.s[j] - 0.5 * length, end = strip.s[j] + 0.5 * length;
  if (strip.mid_touch && j == strip.marker) {
    wide.mid_touch = false;
    if (!strip.half) wide.split(j - 1, begin, strip.parts[j - 1].kind, between);
    wide.split(wide.marker, end, between, strip.parts[j].kind);
    wide.parts[wide.marker].fresh = true;
    if (!strip.half) wide.parts[wide.marker - 1].fresh = true;
  } else {
    wide.split(j, end, between, strip.parts[j].kind);
    wide.s[j] = begin;
    wide.parts[j].fresh = true;
  }
  return wide.successor();
}

std::vector<Successor> after_curvature(const ContactEvent& event, const Strip& strip,
                                       const Profile& profile) {
  std::vector<Successor> out;
  const int j = event.place;
  // A neighbouring gap that lies on the cylinder all along closes as a whole.
  for (const int i : {j - 1, j}) {
    if (i < 0 || strip.parts[i].kind != Stretch::gap) continue;
    double widest = 0.0;
    for (Eigen::Index k = 0; k < profile.pieces[i].s.size(); ++k)
      widest = std::max(widest, std::abs(chain::gap(profile.pieces[i].r.col(k))));
    if (widest > 1e-5) continue;
    const auto is_line = [&](int part) {
      return part >= 0 && part < static_cast<int>(strip.parts.size()) &&
             strip.parts[part].kind == Stretch::line;
    };
    // Two touches that meet become one. Their curvature vanishes with the gap, whichever is seen first.
    constexpr double shortest = 0.05;
    Strip met = strip;
    if (!is_line(i - 1) && !is_line(i + 1) && strip.s[i + 1] - strip.s[i] < shortest && met.collapse(i))
      out.push_back(met.successor());
    Strip closed = strip;
    closed.merge(is_line(i - 1) ? i - 1 : i, is_line(i + 1) ? i + 1 : i, Stretch::line);
    out.push_back(closed.successor());
  }
  // The touch flattens to a line, or where a line would pull (under low tension) comes apart into two.
  for (const Stretch between : {Stretch::line, Stretch::gap})
    for (const double length : {0.05, 0.02, 0.1}) out.push_back(widened(strip, j, between, length));
  return out;
}

std::vector<Successor> after_graze(const ContactEvent& event, Strip strip) {
  const int i = event.place;
  if (!strip.mid_touch && strip.starts_at_mid(i) && std::abs(event.s) < 1e-9) {
    strip.mid_touch = true;
    return {strip.successor()};
  }
  const Stretch kind = strip.parts[i].kind;
  const bool left_tail = !strip.half && i == 0, right_tail = kind == Stretch::tail && !left_tail;
  strip.split(i, event.s, left_tail ? Stretch::tail : Stretch::gap,
              right_tail ? Stretch::tail : Stretch::gap);
  return {strip.successor()};
}

/// Candidates for what follows the event, the other half of a full chain left as it is.
std::vector<Successor> one_sided(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                 const std::vector<double>& s, const Scales& scales) {
  const Strip strip(topology, s);
  switch (event.kind) {
    case Kind::pressure:
      // With a line that shrinks to nothing its pressure (phi = pi) or its edges' forces may change sign.
      if (vanishes(strip, event.place)) return after_length(event.place, strip);
      return after_pressure(event, strip, profile.pieces[event.place], scales);
    case Kind::closure:
      return {closed(event, strip, profile, topology, scales)};
    case Kind::arc:
      return with_arc(event, strip, profile, topology, scales);
    case Kind::length: {
      std::vector<Successor> out;
      if (height_between_lines(profile, topology, event.place, scales))
        if (const auto next = without_arc(event.place, strip)) out.push_back(*next);
      for (Successor& next : after_length(event.place, strip)) out.push_back(std::move(next));
      return out;
    }
    case Kind::force:
      for (const int link : {event.place - 1, event.place})
        if (vanishes(strip, link)) return after_length(link, strip);
      return after_force(event, strip, profile, topology, scales);
    case Kind::curvature:
      return after_curvature(event, strip, profile);
    case Kind::graze:
      return after_graze(event, strip);
  }
  return {};
}

/// The same with the change made on both sides: the half that changed and its mirror image.
/// @param links  of the old chain
Successor both_sided(const Successor& next, bool right_changed, int links) {
  const auto marker = static_cast<int>(next.topology.left.size());
  Successor out = next;
  out.topology.left = out.topology.right = right_changed ? next.topology.right : next.topology.left;
  const auto half = static_cast<int>(out.topology.right.size());
  const auto kept = [&](int k) {
    return right_changed ? marker + k : marker - 1 - k;
  };  // k from the mid-point
  out.s.assign(2 * half + 1, 0.0);
  out.source.assign(2 * half, 0);
  out.opened.clear();
  for (int k = 0; k < half; ++k) {
    out.s[half + 1 + k] = std::abs(next.s[right_changed ? marker + k + 1 : marker - 1 - k]);
    out.s[half - 1 - k] = -out.s[half + 1 + k];
    const int source = next.source[kept(k)], image = links - 1 - source;
    out.source[half + k] = right_changed ? source : image;
    out.source[half - 1 - k] = right_changed ? image : source;
    if (std::find(next.opened.begin(), next.opened.end(), kept(k)) == next.opened.end()) continue;
    out.opened.push_back(half + k);
    out.opened.push_back(half - 1 - k);
  }
  std::vector<chain::MicroGaps> gaps(2 * half);
  for (int k = 0; k < half; ++k) {
    const chain::MicroGaps own = next.topology.micro_gaps_of(kept(k));
    gaps[half + k] = right_changed ? own : own.reversed();
    gaps[half - 1 - k] = gaps[half + k].reversed();
  }
  out.topology.set_micro_gaps(std::move(gaps));
  out.nothing_left = !out.topology.contact();
  return out;
}

/// Do the gaps without arcs differ on one side of the mid-point, link by link from there?
bool gaps_differ(const Topology& a, const Topology& b, bool right) {
  const auto gaps = [&](const Topology& t) {
    const int marker = t.half ? 0 : static_cast<int>(t.left.size());
    std::vector<chain::MicroGaps> out;
    for (int k = 0; k < static_cast<int>(right ? t.right.size() : t.left.size()); ++k)
      out.push_back(t.micro_gaps_of(right ? marker + k : marker - 1 - k));
    return out;
  };
  return gaps(a) != gaps(b);
}

bool symmetric(const Topology& topology, const std::vector<double>& s) {
  constexpr double same = 1e-6;
  if (topology.half || topology.left != topology.right) return false;
  const int links = static_cast<int>(s.size()) - 1;
  for (int i = 0; i < links; ++i)
    if (topology.micro_gaps_of(i) != topology.micro_gaps_of(links - 1 - i).reversed()) return false;
  for (std::size_t j = 0; j < s.size(); ++j)
    if (!(std::abs(s[j] + s[s.size() - 1 - j]) < same)) return false;
  return true;
}

}  // namespace

std::vector<Successor> successors(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                  const std::vector<double>& s, const Scales& scales) {
  std::vector<Successor> out;
  for (Successor& next : one_sided(event, profile, topology, s, scales)) {
    // Of a symmetric state mirror images go together.
    const bool right = next.topology.right != topology.right || gaps_differ(next.topology, topology, true);
    const bool left = next.topology.left != topology.left || gaps_differ(next.topology, topology, false);
    if (right != left && symmetric(topology, s))
      out.push_back(both_sided(next, right, static_cast<int>(profile.pieces.size())));
    out.push_back(std::move(next));
  }
  return out;
}

}  // namespace windlass::equilibrium
