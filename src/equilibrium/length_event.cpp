#include "length_event.hpp"

#include <algorithm>
#include <cmath>

#include "dense_samples.hpp"
#include "end_events.hpp"
#include "lies_flat.hpp"
#include "opened_press.hpp"
#include "strand_line_events.hpp"
#include "touch_dip.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// Two touches at the ends of a short gap: with it their curvature, its height and all that tells them apart vanishes.
bool hardly_apart(const Profile& profile, int link) {
  constexpr double short_gap = 0.02, flat = 1e-6;
  if (profile.pieces[link].stretch != Stretch::gap ||
      profile.pieces[link].length() > short_gap * profile.unit_length)
    return false;
  int touches = 0;
  for (const Contact& c : profile.contacts)
    touches += !c.edge && (c.joint == link || c.joint == link + 1) && c.gap_curvature < flat;
  return touches == 2;
}

/// Length of a gap over that which its line carries, by the force F at its edges, less than the one when it became an arc:
/// inside a line F = a h³/15, so that |p₀| w⁴ = 0.96 F h³; beside a touch F = bℓ²/20 and |p_e| w² = 4.32 F ℓ. Nothing where
/// no line carries it.
std::optional<double> beyond_carried(const Profile& profile, int link, bool begins_at_mid) {
  constexpr double shorter = 0.6;
  int edges = 0, touches = 0, obstacle = -1;
  double force = 0.0;
  for (const Contact& c : profile.contacts) {
    if (c.joint != link && c.joint != link + 1) continue;
    if (c.coupling >= 0 || (obstacle >= 0 && c.obstacle != obstacle)) return std::nullopt;
    obstacle = c.obstacle;
    ++(c.edge ? edges : touches);
    if (c.edge) force += c.force + c.layer;
  }
  const bool about_mid = begins_at_mid && edges == 1 && touches == 0,
             beside_touch = edges == 1 && touches == 1;
  if (!about_mid && !beside_touch && edges != 2) return std::nullopt;
  const double length = profile.pieces[link].length(), mean = std::max(force / edges, 0.0);
  const double height = 0.96 * mean * std::pow(about_mid ? length : 0.5 * length, 3);
  double part = std::pow(height / carried_inside, 1.0 / 6.0);
  // Beside a touch the gap may have opened inside the line and reached its edge.
  if (beside_touch) part = std::max(part, std::cbrt(4.32 * mean * length / carried_beside_touch));
  return part - shorter;
}

/// A line without pressure (see rod::buckling_margin) has none to stand for a gap.
bool beside_unpressed(const Profile& profile, int link) {
  const int last = static_cast<int>(profile.pieces.size()) - 1;
  return (link > 0 && profile.pieces[link - 1].buckling) ||
         (link < last && profile.pieces[link + 1].buckling);
}

/// Length at which a line with hardly any force at an edge gives way: rounding of its frames, over its length, must stay below
/// a thousandth of that force, or it moves the edge.
double least_under(const Profile& profile, int line) {
  constexpr double rounding = 1e-9, most = 10.0 * least_length;
  double least = least_length;
  for (const Contact& c : profile.contacts)
    if (c.edge && (c.joint == line || c.joint == line + 1) && c.force + c.layer > 0.0)
      least = std::max(least, std::min(most, rounding / ((c.force + c.layer) * profile.unit_length)));
  return least;
}

}  // namespace

ContactEvent length_event(const Profile& profile, const Topology& topology, const chain::Strands& strands,
                          int i) {
  if (const int line = line_of_several(strands, i); line >= 0)
    return spare_touches(profile, strands, i, line);
  if (const auto between = laid_between(profile, strands, i)) return *between;
  const bool begins_at_mid = topology.half && i == 0 && !topology.mid_touch;
  const Piece& piece = profile.pieces[i];
  const bool gap = piece.stretch == Stretch::gap;
  const auto carried =
      gap && !beside_unpressed(profile, i) ? beyond_carried(profile, i, begins_at_mid) : std::nullopt;
  const auto is_touch = [&](const Contact& c) { return !c.edge && (c.joint == i || c.joint == i + 1); };
  const bool between_touches =
      gap && std::count_if(profile.contacts.begin(), profile.contacts.end(), is_touch) == 2;
  const double stiffest = profile.material.stiffness.maxCoeff() / profile.material.bending_stiffness;
  const auto opened = opened_press(profile, topology, i);
  // The two ends of a line between free strands share a force, by the curvature there: as two touches of a gap.
  const int line = strands.line_along(i);
  const bool shrinks = line >= 0 && !strands.lines()[line].on_obstacles && line == strands.line_of(i) &&
                       line == strands.line_of(i + 1);
  // What lies flat beyond a plate's touch carries nothing, and where it ends is found from the touch at the rod's end.
  const bool flat_tail = std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const Contact& c) {
    return is_touch(c) && c.obstacle >= 0 && is_plate(profile.obstacles, c.obstacle) &&
           lies_flat(profile, topology, i, c.obstacle);
  });
  const double shortest = piece.stretch == Stretch::tail ? flat_tail ? least_length : shortest_tail * stiffest
                          : shrinks                      ? least_between_touches
                          : opened                       ? least_lever
                          : topology.beside_strand(i)    ? least_beside_strand
                          : between_touches              ? least_between_touches
                          : piece.stretch == Stretch::line ? least_under(profile, i)
                                                           : least_length;
  const double least = shortest * profile.unit_length;
  constexpr double shorter = 0.6;
  if (opened && opened->gap == i) {
    ContactEvent event{Kind::length, i, part_of_carried(profile, *opened) - shorter, piece.s(0)};
    event.redrawn = true;
    return event;
  }
  if (const auto part = part_of_carried(profile, strands, i); part && !carried) {
    ContactEvent event{Kind::length, i, *part - shorter, piece.s(0)};
    event.redrawn = true;
    return event;
  }
  if (const auto part = part_of_opened(profile, strands, i)) {
    ContactEvent event{Kind::length, i, *part - shorter, piece.s(0)};
    event.redrawn = true;
    return event;
  }
  ContactEvent event{Kind::length, i, carried.value_or(piece.length() - least), piece.s(0)};
  event.redrawn = carried.has_value();
  event.imminent = hardly_apart(profile, i);
  return event;
}

}  // namespace windlass::equilibrium
