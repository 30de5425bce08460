#include "obstacle_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "end_events.hpp"
#include "opened_press.hpp"
#include "strand_successors.hpp"
#include "windlass/obstacle/rim.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;

namespace {

/// Lengths to try for a gap that opens where the pressure is negative over `width`. A beam held off by the pressure
/// p₀ + a x² needs √5 times that width for g = g' = g'' = 0 at its ends, one held at a touch 5/3 of it; at the event
/// itself the width is nothing, and the load gives way to any length: by its square inside, in proportion at an edge.
std::vector<double> gap_lengths(double width, double factor, double usual, double most) {
  std::vector<double> out;
  for (const double part : {1.0, 0.5, 2.0, 3.0})
    out.push_back(std::min(most, part * (width > 1e-6 ? factor * width : usual)));
  return out;
}

}  // namespace

std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip, const Profile& profile) {
  std::vector<Successor> out;
  const int i = event.place;
  const Piece& line = profile.pieces[i];
  const double begin = strip.s[i], end = strip.s[i + 1], length = end - begin;
  Strip open = strip;  // the whole line lifts at once
  open.parts[i].kind = Stretch::gap;
  open.on[i + 1].flat = strip.on[i].flat;  // its edges are touches now, on the plate, too
  const double low = event.from, high = event.to, width = high - low;
  const bool at_start = low <= begin, at_end = high >= end;
  if (event.kind == ContactEvent::Kind::suction && at_start && at_end)
    for (const bool last : {false, true})
      if (pressed_by(profile, strip, last ? i + 1 : i))
        out.push_back(lifted_beside_press(i, strip, profile, last));
  if (line.p.maxCoeff() - line.p.minCoeff() < 1e-6) {
    out.push_back(open.successor());
    return out;
  }
  const bool at_mid = at_start && strip.starts_at_mid(i) && !strip.mid_touch;
  if (at_start != at_end && pressed_by(profile, strip, at_end ? i + 1 : i)) {
    for (const double size : gap_lengths(width, gap_beside_touch, 0.05, 0.9 * length))
      out.push_back(opened_under_press(i, strip, profile, at_end, size));
    return out;
  }
  const auto cut = [&](Strip part, int link, double from, double to) {  // a gap [from, to] inside a link
    const bool before = from > part.s[link], after = to < part.s[link + 1];
    if (after) part.split(link, to, Stretch::gap, Stretch::line);
    if (before) part.split(link, from, Stretch::line, Stretch::gap);
    part.parts[link + before].fresh = true;
    return part;
  };
  if (at_mid) {
    for (const double size : gap_lengths(width, gap_inside, 0.3, 1.8 * length))
      out.push_back(cut(strip, i, begin, begin + 0.5 * size).successor());
  } else if (at_start ||
             at_end) {  // the edge's point force stays: a touch, with a gap between it and the line
    for (const double size : gap_lengths(width, gap_beside_touch, 0.05, 0.9 * length))
      out.push_back(
          (at_end ? cut(strip, i, end - size, end) : cut(strip, i, begin, begin + size)).successor());
  } else {
    const double middle = 0.5 * (low + high), room = 1.8 * std::min(middle - begin, end - middle);
    // Close to an edge no line is left beyond the gap, or next to nothing, only the edge's point force.
    const double half = 0.5 * gap_inside * width, close = gap_reaches_edge * half;
    for (const double part : {1.0, 1.5}) {
      if (end - middle < close) out.push_back(cut(strip, i, middle - part * half, end).successor());
      if (middle - begin < close) out.push_back(cut(strip, i, begin, middle + part * half).successor());
    }
    for (const double size : gap_lengths(width, gap_inside, 0.3, room))
      out.push_back(cut(strip, i, middle - 0.5 * size, middle + 0.5 * size).successor());
  }
  out.push_back(open.successor());
  return out;
}

bool vanishes(const Strip& strip, int link) {
  constexpr double vanished = 3.0 * least_length;
  return strip.is_line(link) && std::abs(strip.s[link + 1] - strip.s[link]) < vanished;
}

namespace {

/// Gaps of the same length at an event are mirror images on a full chain, and close together.
bool closes_with(const Strip& strip, int link, int other) {
  constexpr double same = 1e-3 * least_length;
  const auto length = [&](int i) { return std::abs(strip.s[i + 1] - strip.s[i]); };
  return strip.parts[link].kind == Stretch::gap && strip.parts[other].kind == Stretch::gap &&
         std::abs(length(link) - length(other)) < same;
}

}  // namespace

std::vector<Successor> after_length(int link, const Strip& strip) {
  std::vector<Successor> out;
  if (const auto next = after_length_beside_strand(link, strip)) return {*next};
  // In long helices lines shrink to nothing together, at distances that differ by less than rounding.
  Strip together = strip;
  int count = 0;
  for (int i = static_cast<int>(strip.parts.size()); i-- > 0;)
    if (i == link || vanishes(strip, i) || closes_with(strip, link, i)) count += together.collapse(i);
  if (count > 1) out.push_back(together.successor());
  Strip alone = strip;
  if (alone.collapse(link)) out.push_back(alone.successor());
  return out;
}

std::vector<Successor> after_force(const ContactEvent& event, Strip strip, const Profile& profile,
                                   const Topology& topology) {
  const int j = event.place;
  if (is_end(strip, j)) {
    strip.on[j] = {};
    float_where_one_is_left(profile, strip);
    return {strip.successor()};
  }
  if (strip.mid_touch && j == 0) {
    strip.mid_touch = false;
    return {strip.successor()};
  }
  const Stretch before = strip.parts[j - 1].kind, after = strip.parts[j].kind;
  if (before == Stretch::line || after == Stretch::line) return {};
  constexpr double lifted =
      1e-6;  // with the last force the rod leaves the cylinder, from mirror images at once
  strip.merge(j - 1, j, joined(before, after));
  float_where_one_is_left(profile, strip);
  Successor next = strip.successor();
  next.nothing_left |= chain::total_contact_force(profile, topology) < lifted;
  return {next};
}

namespace {

/// A touch replaced by a stretch of a given length.
Successor widened(const Strip& strip, int j, Stretch between, double length) {
  Strip wide = strip;
  const double begin = strip.s[j] - 0.5 * length, end = strip.s[j] + 0.5 * length;
  if (strip.mid_touch && j == 0) {
    wide.mid_touch = false;
    wide.split(0, end, between, strip.parts[0].kind);
    wide.parts[0].fresh = true;
  } else {
    wide.split(j, end, between, strip.parts[j].kind);
    wide.s[j] = begin;
    wide.parts[j].fresh = true;
  }
  return wide.successor();
}

/// Has a gap bowed off its plane, by A (1 − cos ks) with hardly more curvature A k² than the touches at its ends give way at?
bool slightly_bowed(const Profile& profile, int gap, double height) {
  const double k2 = profile.pieces[gap].n.col(0).norm();
  for (const chain::Contact& c : profile.contacts)
    if ((c.joint == gap || c.joint == gap + 1) && c.coupling < 0 &&
        profile.obstacles[c.obstacle].curvature() == 0.0)
      return height * k2 < 4.0 * least_curvature * c.force / std::sqrt(k2);
  return false;
}

/// A gap that lies on the obstacle of its ends all along closes as a whole, whichever is seen first, a touch's curvature or a
/// place of it below the surface. Nothing for others.
std::vector<Successor> closed_whole(int gap, int obstacle, const Strip& strip, const Profile& profile) {
  double widest = 0.0;
  for (Eigen::Index k = 0; k < profile.pieces[gap].s.size(); ++k)
    widest = std::max(widest, std::abs(profile.obstacles[obstacle].gap(profile.pieces[gap].r.col(k))));
  if (widest > 1e-5 && !slightly_bowed(profile, gap, widest)) return {};
  std::vector<Successor> out;
  // Two touches that meet become one. Their curvature vanishes with the gap.
  constexpr double shortest = 0.05;
  const bool before = strip.is_line(gap - 1), after = strip.is_line(gap + 1);
  Strip met = strip;
  if (!before && !after && strip.s[gap + 1] - strip.s[gap] < shortest && met.collapse(gap))
    out.push_back(met.successor());
  Strip closed = strip;
  closed.merge(before ? gap - 1 : gap, after ? gap + 1 : gap, Stretch::line);
  out.push_back(closed.successor());
  return out;
}

}  // namespace

std::vector<Successor> after_curvature(const ContactEvent& event, const Strip& strip,
                                       const Profile& profile) {
  std::vector<Successor> out;
  const int j = event.place;
  for (const int i : {j - 1, j}) {
    if (i < 0 || strip.parts[i].kind != Stretch::gap) continue;
    for (Successor& closed : closed_whole(i, strip.on[j].obstacle, strip, profile))
      out.push_back(std::move(closed));
  }
  // The touch flattens to a line, or where a line would pull (under low tension) comes apart into two.
  const auto widen = [&](std::initializer_list<double> lengths) {
    for (const Stretch between : {Stretch::line, Stretch::gap})
      for (const double length : lengths)
        out.push_back(widened(strip, j, between, length * profile.unit_length));
  };
  widen({0.05, 0.02, 0.1});
  // Where nearly all of the force stays at one end a line grows slowly: a longer one lies far from the event.
  widen({5e-3, 2e-3});
  return out;
}

std::vector<Successor> after_graze(const ContactEvent& event, const Strip& strip, const Profile& profile) {
  if (auto next = end_touches(event, profile, strip)) return {*next};
  const int i = event.place;
  Strip touched = strip;
  if (!strip.mid_touch && strip.starts_at_mid(i) && std::abs(event.s) < 1e-9) {
    touched.mid_touch = true;
    touched.on[0] = {event.obstacle};
  } else {
    chain::Seat seat{event.obstacle};
    for (const int joint : {i, i + 1})  // a rod that lies flat in a plate stays there
      if (!strip.is_line(joint - 1) && !strip.is_line(joint))
        seat.flat = std::max(seat.flat, strip.on[joint].flat);
    touched.cut(i, event.s, seat);
  }
  std::vector<Successor> out{touched.successor()};
  const bool ends_there = strip.on[i + 1].obstacle == event.obstacle &&
                          (strip.starts_at_mid(i) || strip.on[i].obstacle == event.obstacle);
  if (strip.parts[i].kind == Stretch::gap && ends_there)
    for (Successor& closed : closed_whole(i, event.obstacle, strip, profile))
      out.push_back(std::move(closed));
  return out;
}

Successor end_of_rod(const Strip& strip) {
  Successor next = strip.successor();
  next.at_end = true;
  return next;
}

Successor past_the_rim(const ContactEvent& event, Strip strip, const Profile& profile) {
  const int j = event.place;
  chain::Seat& seat = strip.on[j];
  if (is_end(strip, j)) {  // the end of the rod is beside the plate now: it is not pushed any longer
    Successor next = strip.successor();
    next.at_rim = true;
    return next;
  }
  const auto rim = obstacle::as_rim(profile.obstacles.pointer(seat.obstacle));
  const chain::Contact* here = profile.contact_at(j);
  const bool touch = seat.strand == 0 && seat.flat < 0 && !strip.is_line(j - 1) && !strip.is_line(j);
  constexpr double half_way = 0.5;  // of the force's tilt, by the square of its sine
  const bool to_plate = rim && std::pow(rim->across(here->r, here->normal)(0), 2) < half_way;
  if (touch && (!rim || to_plate)) {
    seat.obstacle += rim ? -1 : 1;
    return strip.successor();
  }
  Successor next = strip.successor();
  next.at_rim = true;
  return next;
}

Successor bowed(int link, Strip strip) {
  strip.parts[link].kind = Stretch::gap;
  Successor next = strip.successor();
  next.bowed = link;
  return next;
}

}  // namespace windlass::equilibrium
