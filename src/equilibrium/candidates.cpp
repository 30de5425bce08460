#include <algorithm>
#include <cmath>
#include <utility>

#include "candidates.hpp"
#include "end_events.hpp"
#include "lies_flat.hpp"
#include "line_touches.hpp"
#include "opened_press.hpp"
#include "plate_successors.hpp"
#include "strand_line_events.hpp"
#include "strand_successors.hpp"
#include "strip.hpp"
#include "touch_dip.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/obstacle/rim.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

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

std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip, const Profile& profile) {
  std::vector<Successor> out;
  const int i = event.place;
  const Piece& line = profile.pieces[i];
  const double begin = strip.s[i], end = strip.s[i + 1], length = end - begin;
  Strip open = strip;  // the whole line lifts at once
  open.parts[i].kind = Stretch::gap;
  open.on[i + 1].flat = strip.on[i].flat;  // its edges are touches now, on the plate, too
  if (line.p.maxCoeff() - line.p.minCoeff() < 1e-6) return {open.successor()};
  const double low = event.from, high = event.to, width = high - low;
  const bool at_start = low <= begin, at_end = high >= end;
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

/// A line that has this length or less at an event shrinks to nothing there.
bool vanishes(const Strip& strip, int link) {
  constexpr double vanished = 3.0 * least_length;
  return strip.is_line(link) && std::abs(strip.s[link + 1] - strip.s[link]) < vanished;
}

/// Gaps of the same length at an event are mirror images on a full chain, and close together.
bool closes_with(const Strip& strip, int link, int other) {
  constexpr double same = 1e-3 * least_length;
  const auto length = [&](int i) { return std::abs(strip.s[i + 1] - strip.s[i]); };
  return strip.parts[link].kind == Stretch::gap && strip.parts[other].kind == Stretch::gap &&
         std::abs(length(link) - length(other)) < same;
}

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

/// What touches at the rod's end need not be tangent there: another mechanics.
Successor end_of_rod(const Strip& strip) {
  Successor next = strip.successor();
  next.at_end = true;
  return next;
}

/// What touches a plate at its outer edge presses on that edge next, which comes behind it in the scene, and the other way round. Lines
/// and strands do not, nor what reaches the plate's outer side.
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

/// A line that has buckled off its obstacle: its edges are touches now.
Successor bowed(int link, Strip strip) {
  strip.parts[link].kind = Stretch::gap;
  Successor next = strip.successor();
  next.bowed = link;
  return next;
}

/// What follows where an arc has no length left, or a touch of strands comes apart. Joints that locate themselves meet and part; the
/// touches inside lines follow them.
std::vector<Successor> after_skeleton(const ContactEvent& event, const Profile& profile,
                                      const Topology& topology, const Strip& strip) {
  const chain::Strands strands(topology);
  const auto follows = [&](int joint) { return strands.laid(joint) || !strands.inside_line(joint); };
  const auto laid = [&](int joint) { return strands.laid(joint); };
  const Skeleton skeleton = skeleton_of(strip);
  ContactEvent here = event;
  const bool length = event.kind == Kind::length;
  const bool alone = length && ((!laid(event.place) && !laid(event.place + 1)) || !follows(event.place) ||
                                !follows(event.place + 1));
  if (alone || skeleton.strip.s.size() == strip.s.size()) {
    if (!length) return strands_split(event, strip, profile);
    std::vector<Successor> out = line_passes(event.place, false, profile, topology, strip);
    for (const auto& others :
         {after_length(event.place, strip), line_passes(event.place, true, profile, topology, strip)})
      out.insert(out.end(), others.begin(), others.end());
    return out;
  }
  here.place = (length ? skeleton.link : skeleton.joint)[event.place];
  std::vector<Successor> out =
      length ? after_length(here.place, skeleton.strip) : strands_split(here, skeleton.strip, profile);
  for (Successor& next : out) next = with_touches(next, profile, topology);
  return out;
}

/// Strands that meet where one of them lies flat in a plate, right behind the plate's touch: it stays there.
std::vector<Successor> strands_meet_in_plate(const ContactEvent& event, const Strip& strip,
                                             const Profile& profile, const Topology& topology) {
  std::vector<Successor> out = strands_meet(event, strip);
  for (Successor& next : out)
    for (int j = 0; j < static_cast<int>(next.topology.on.size()); ++j)
      for (int plate = 1; plate < profile.obstacles.size(); ++plate)
        for (const auto& [link, s] : {std::pair(event.place, event.s), std::pair(event.other, event.s_other)})
          if (chain::Seat& seat = next.topology.on[j];
              seat.strand != 0 && next.s[j] == s && profile.obstacles[plate].curvature() == 0.0 &&
              !strip.is_line(link) && lies_flat(profile, topology, link, plate))
            seat.obstacle = seat.flat = plate;
  return out;
}

/// Where two touches' forces together are: the part of the way from the first to the second.
double centre_of_forces(const Profile& profile, int first, int second) {
  const auto force = [&](int joint) { return std::max(profile.contact_at(joint)->force, 0.0); };
  const double one = force(first), two = force(second);
  return one + two > 0.0 ? two / (one + two) : 0.5;
}

/// Two touches that a touch between them stands for (touch_dip.hpp): where their forces together are.
std::vector<Successor> become_one(int link, const Profile& profile, const Topology& topology,
                                  const Strip& strip) {
  Skeleton skeleton = skeleton_of(strip);
  const double part = centre_of_forces(profile, link, link + 1);
  std::vector<double>& s = skeleton.strip.s;
  std::vector<double> places;
  const auto meet = [&](int one, int two) {
    const int a = skeleton.joint[one], b = skeleton.joint[two];
    s[a] = s[b] = (1.0 - part) * s[a] + part * s[b];
    places.push_back(s[a]);
  };
  meet(link, link + 1);
  if (partner(strip, link) != link + 1) meet(partner(strip, link), partner(strip, link + 1));
  const auto next = after_length_beside_strand(skeleton.joint[link], skeleton.strip);
  if (!next) return {};
  Successor out = with_touches(*next, profile, topology);
  hold_at(places, out);
  return {out};
}

/// The end of a line takes what presses right before it, and is where the forces of both together are.
Successor end_takes_press(const LaidAnew& here, const Profile& profile, const Topology& topology,
                          const Strip& strip) {
  Skeleton skeleton = skeleton_of(strip);
  const double part = centre_of_forces(profile, here.line_end, here.pressed);
  std::vector<double> places;
  for (const auto& [at, pressed] : {std::pair(here.line_end, here.pressed),
                                    std::pair(partner(strip, here.line_end), partner(strip, here.pressed))}) {
    double& s = skeleton.strip.s[skeleton.joint[at]];
    s += part * (strip.s[pressed] - s);
    places.push_back(s);
  }
  Successor out = with_touches(skeleton.strip.successor(), profile, topology);
  hold_at(places, out);
  return out;
}

/// The touches of lines laid anew, a line with the own image open about its middle where that is why.
std::vector<Successor> laid_anew(const LaidAnew& here, const Profile& profile, const Topology& topology,
                                 const Strip& strip) {
  std::vector<Successor> out;
  if (here.middle >= 0)
    out = line_opens_about(here.middle, here.begin + here.end - here.middle, profile, topology, strip);
  if (here.pressed >= 0) out.push_back(end_takes_press(here, profile, topology, strip));
  out.push_back(with_touches(skeleton_of(strip).strip.successor(), profile, topology));
  return out;
}

/// Do strands meet where a line of theirs is open about its middle?
bool opens_line(const ContactEvent& event, const Topology& topology) {
  const chain::Strands strands(topology);
  const chain::Strands::Facing* facing = strands.facing(event.place, event.other, event.mirrored);
  return facing && strands.opened_middle(*facing);
}

/// Are the joints about a place where they were, but for what is little next to the distance between them?
bool alike(const Successor& next, const Strip& strip, double s) {
  constexpr double about = 0.05, little = 0.1;
  const auto near = [&](const std::vector<double>& all) {
    std::vector<double> out;
    std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                 [&](double at) { return std::abs(at - s) < about; });
    return out;
  };
  const std::vector<double> before = near(strip.s), after = near(next.s);
  if (before.size() != after.size()) return false;
  for (std::size_t k = 1; k + 1 < before.size(); ++k)
    if (std::abs(after[k] - before[k]) > little * (before[k + 1] - before[k - 1])) return false;
  return true;
}

}  // namespace

std::vector<Successor> one_sided(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                 const std::vector<double>& s) {
  const Strip strip(topology, s);
  switch (event.kind) {
    case Kind::pressure:
    case Kind::suction:
      // With a line that shrinks to nothing its pressure (phi = pi) or its edges' forces may change sign.
      if (vanishes(strip, event.place)) return after_length(event.place, strip);
      {
        std::vector<Successor> out = flat_line_lifts(event.place, strip, profile);
        const auto others = after_pressure(event, strip, profile);
        out.insert(out.end(), others.begin(), others.end());
        return out;
      }
    case Kind::length:
      if (profile.pieces[event.place].stretch == Stretch::tail) {
        if (const auto next = touch_reaches_end(event.place, profile, strip)) return {*next};
        return {end_of_rod(strip)};
      }
      if (const auto opened = opened_press(profile, topology, event.place); opened && event.redrawn)
        return {closed_under_press(*opened, strip)};
      if (auto flat = flat_line_begins_or_ends(event.place, profile, strip); !flat.empty()) return flat;
      if (const auto fewer = line_with_fewer_touches(profile, topology, event.place, strip)) return {*fewer};
      if (const auto anew = laid_anew_at(profile, chain::Strands(topology), event.place);
          anew && event.redrawn)
        return laid_anew(*anew, profile, topology, strip);
      if (event.redrawn && part_of_carried(profile, chain::Strands(topology), event.place))
        return become_one(event.place, profile, topology, strip);
      return after_skeleton(event, profile, topology, strip);
    case Kind::force:
      for (const int link : {event.place - 1, event.place})
        if (vanishes(strip, link)) return after_length(link, strip);
      if (const auto opened = line_opens(event.place, topology, strip)) {
        std::vector<Successor> out = {*opened}, parted = strands_part(event.place, strip);
        out.insert(out.end(), parted.begin(), parted.end());
        if (event.redrawn) {  // laid unevenly touches pull, too
          const Successor anew = with_touches(skeleton_of(strip).strip.successor(), profile, topology);
          if (!alike(anew, strip, event.s)) out.insert(out.begin(), anew);
          const auto by_suction = line_opens_by_suction(event.place, profile, topology, strip);
          out.insert(out.begin(), by_suction.begin(), by_suction.end());
        }
        return out;
      }
      if (strip.on[event.place].strand != 0) return strands_part(event.place, strip);
      return after_force(event, strip, profile, topology);
    case Kind::dip:
    case Kind::curvature:
      if (const auto line = line_with_next(event.place, profile, topology, strip)) return {*line};
      if (strip.on[event.place].strand != 0) {
        std::vector<Successor> out = after_skeleton(event, profile, topology, strip);
        if (const auto joined = line_joins(event.place, profile, topology, strip))
          out.insert(out.begin(), *joined);
        if (const auto line = line_of_three(event.place, profile, topology, strip)) out.push_back(*line);
        return out;
      }
      return after_curvature(event, strip, profile);
    case Kind::graze:
      return after_graze(event, strip, profile);
    case Kind::buckling:
      return {bowed(event.place, strip)};
    case Kind::rim:
      return {past_the_rim(event, strip, profile)};
    case Kind::slope:
      return touch_leaves_end(event, strip);
    case Kind::room:
      return touches_both(profile, strip);
    case Kind::reaction:
      return strand_lifts(event.place, strip);
    case Kind::approach:
      if (event.redrawn && !opens_line(event, topology)) {
        return {*line_with_more_touches(event, profile, topology, strip),
                *line_filled(event, profile, topology, strip)};
      }
      if (auto closed = line_closes(event, topology, strip)) {
        closed = with_touches(skeleton_of(Strip(*closed)).strip.successor(), profile, topology);
        // Beside a line hardly anything parts it from what comes next; between two touches a third is one by itself at first.
        const bool beside_line = next_to_line(event, topology);
        std::vector<Successor> out = strands_meet_in_plate(event, strip, profile, topology);
        out.insert(beside_line ? out.begin() : out.end(), *closed);
        if (const auto longer = line_extends(event, topology, strip)) out.insert(out.begin(), *longer);
        return out;
      }
      return strands_meet_in_plate(event, strip, profile, topology);
  }
  return {};
}

}  // namespace windlass::equilibrium
