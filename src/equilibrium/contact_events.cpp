#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "dense_samples.hpp"
#include "end_events.hpp"
#include "lies_flat.hpp"
#include "line_pressure.hpp"
#include "rim_events.hpp"
#include "strand_line_events.hpp"
#include "touch_dip.hpp"
#include "windlass/chain/self_distance.hpp"
#include "windlass/obstacle/rim.hpp"
#include "windlass/rod/free_flow.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// A least gap found on an element's polynomial, brought to where it is on the rod's own way through the element: between the
/// element's ends, where the state is known to more digits, the polynomial may be off by more than events allow, and
/// next to a contact may dip where the rod does not. Nothing where the rod has no least gap there but its contact.
std::optional<Least> on_its_way(const Profile& profile, const Piece& piece, const obstacle::Surface& surface,
                                double s) {
  const Eigen::Index node = element_at(piece, s), last = piece.s.size() - 1;
  const rod::Section start{piece.r.col(node), piece.m.col(node), piece.q.col(node)};
  const Eigen::Vector3d n = piece.n.col(node);
  const double reach = piece.s(node + piece.stride) - piece.s(node);
  const auto section_at = [&](double at) {
    return rod::free_flow(start, n, profile.material, at - piece.s(node));
  };
  const auto slope_at = [&](const rod::Section& at) {
    return surface.normal(at.r).dot(rod::directors(at.q).col(2));
  };
  constexpr double beside = 1e-4;
  rod::Section at = section_at(s);
  double step = reach;
  for (int k = 0; k < 6 && std::abs(step) > beside * beside; ++k) {
    const double slope = slope_at(at), curvature = (slope_at(section_at(s + beside)) - slope) / beside;
    step = -slope / curvature;
    if (!(curvature > 0.0) || std::abs(step) > reach) return std::nullopt;
    at = section_at(s += step);
  }
  const double from_ends = std::min(s - piece.s(0), piece.s(last) - s);
  if (from_ends < beside * reach) return std::nullopt;
  return Least{surface.gap(at.r), s};
}

/// A dip of the gap beside a touch that is about to be two. With g'' at the touch nearly gone g = δ² h(δ) dips at once, to
/// depths that the element's polynomial does not resolve: so on the rod's own way, and of h, for g has no minimum there before
/// it has none that is positive.
std::optional<Least> dip_beside(const Profile& profile, const Piece& piece, const Contact& touch,
                                bool ahead) {
  const Eigen::Index last = piece.s.size() - 1, node = ahead ? 0 : last;
  const obstacle::Surface& surface = profile.obstacles[touch.obstacle];
  const double way = ahead ? 1.0 : -1.0;
  const double reach = std::abs(piece.s(ahead ? piece.stride : last - piece.stride) - piece.s(node));
  const rod::Section start{piece.r.col(node), piece.m.col(node), piece.q.col(node)};
  const Eigen::Vector3d n = piece.n.col(node);
  const auto h = [&](double d) {
    return surface.gap(rod::free_flow(start, n, profile.material, way * d).r) / (d * d);
  };
  constexpr int parts = 24, bits = 26;
  double before = 0.5 * touch.gap_curvature, here = h(reach / parts);
  for (int k = 1; k < parts; ++k) {
    const double after = h(reach * (k + 1) / parts);
    if (here < before && here <= after) {
      const double from = std::max(k - 1.0, 0.1) / parts, to = (k + 1.0) / parts;
      const auto [d, least] = boost::math::tools::brent_find_minima(h, reach * from, reach * to, bits);
      return Least{least * d * d, piece.s(node) + way * d};
    }
    before = here, here = after;
  }
  return std::nullopt;
}

/// Does a tail beside this touch lie flat in its obstacle?
bool before_flat_tail(const Profile& profile, const Topology& topology, const Contact& c) {
  const int count = static_cast<int>(profile.pieces.size());
  return c.coupling < 0 && ((c.joint > 0 && lies_flat(profile, topology, c.joint - 1, c.obstacle)) ||
                            (c.joint < count && lies_flat(profile, topology, c.joint, c.obstacle)));
}

/// Least local minimum of the gap to an obstacle inside a free arc. Next to a contact the gap is flat and its samples are
/// rounding; a minimum must stand out by more than that.
ContactEvent graze(const Profile& profile, const Topology& topology, int obstacle, int link,
                   bool starts_at_mid) {
  constexpr double noise = 1e-11;
  const Piece& piece = profile.pieces[link];
  const obstacle::Surface& surface = profile.obstacles[obstacle];
  const auto at = [&](double value, double s) {
    ContactEvent event{Kind::graze, link, value, s};
    event.obstacle = obstacle;
    return event;
  };
  ContactEvent event = at(far, piece.s(0));
  if (const auto rim = obstacle::as_rim(profile.obstacles.pointer(obstacle)))
    return graze_of_rim(profile, *rim, obstacle, link);
  const Eigen::Index count = piece.s.size();
  Eigen::VectorXd g(count);
  for (Eigen::Index k = 0; k < count; ++k) g(k) = surface.gap(piece.r.col(k));
  if (starts_at_mid && g(0) < g(1)) event = at(g(0), piece.s(0));
  const Dense dense = dense_samples(piece, g);
  for (Eigen::Index k = 1; k + 1 < dense.s.size(); ++k) {
    if (dense.value(k) > dense.value(k - 1) - noise || dense.value(k) > dense.value(k + 1)) continue;
    std::optional<Least> least =
        least_near(piece, g, dense.s(k), dense.value(k), dense.s(k - 1), dense.s(k + 1));
    constexpr double near = 1e-3;
    if (piece.stride > 1 && least->value < near * profile.unit_length)
      least = on_its_way(profile, piece, surface, least->s);
    if (least && std::isfinite(surface.outer_radius()) && inside_rim(surface, profile.at(least->s).r) < 0.0)
      continue;  // beside the plate
    if (least && least->value < event.value) event = at(least->value, least->s);
  }
  if (const auto end = graze_at_end(profile, topology, obstacle, link); end && end->value < event.value)
    event = at(end->value, end->s);
  for (const Contact& c : profile.contacts) {
    constexpr double nearly_gone = 1e-3;  // of g'', over the unit of length
    const bool ahead = c.joint == link, behind = c.joint == link + 1;
    if (piece.stride == 1 || c.edge || c.coupling >= 0 || c.obstacle != obstacle || !(ahead || behind) ||
        c.gap_curvature * profile.unit_length > nearly_gone)
      continue;
    const std::optional<Least> dip = dip_beside(profile, piece, c, ahead);
    if (dip && dip->value < event.value) event = at(dip->value, dip->s);
  }
  return event;
}

/// A rod without torsion that lies on a plate beside a cylinder presses on it at the ends of the line only: between them its
/// pressure is rounding.
bool presses_at_ends_only(const Profile& profile, const Piece& line) {
  constexpr double rounding = 1e-9;
  return profile.obstacles[0].curvature() != 0.0 && profile.obstacles[line.obstacle].curvature() == 0.0 &&
         line.p.cwiseAbs().maxCoeff() < rounding;
}

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

/// Two touches with a short gap between them that have come from one: they meet where its length says so, before their
/// curvature, which falls with the square of it, can.
bool about_to_meet(const Profile& profile, const chain::Strands& strands, const Contact& touch) {
  constexpr double short_gap = 0.02, close = 2.0;  // of what a touch carries
  const auto shorter = [&](int link) {
    if (link < 0 || link >= static_cast<int>(profile.pieces.size()) || strands.welded(link)) return false;
    if (const auto part = part_of_carried(profile, strands, link)) return *part < close;
    return profile.pieces[link].length() < short_gap * profile.unit_length;
  };
  return std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const Contact& c) {
    return c.coupling >= 0 && touch.coupling >= 0 &&
           std::abs(strands.partner(c.joint) - strands.partner(touch.joint)) <= 1 &&
           ((c.joint == touch.joint + 1 && shorter(touch.joint)) ||
            (c.joint == touch.joint - 1 && shorter(c.joint)));
  });
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
  ContactEvent event{Kind::length, i, carried.value_or(piece.length() - least), piece.s(0)};
  event.redrawn = carried.has_value();
  event.imminent = hardly_apart(profile, i);
  return event;
}

/// A force F off the obstacle on a line that is pressed by p lifts it over a length 3F/4p to both sides, in which the moment
/// changes by 3F²/32p: the line carries that, as it carries short gaps, up to F²/p = `carried_under_strand`.
ContactEvent reaction_event(const Profile& profile, const Contact& c) {
  // A strand that is pressed to its obstacle does not lift, whatever becomes of the pressure beside it.
  const double reaction = *c.reaction, pressure = reaction < 0.0 ? profile.pieces[c.joint].p(0) : 1.0;
  ContactEvent event{Kind::reaction, c.joint,
                     1.0 + reaction * std::abs(reaction) / (pressure * carried_under_strand), c.s};
  event.redrawn = true;
  return event;
}

/// Curvature at which a touch gives way, see `least_curvature`.
double least_curvature_at(const Profile& profile, const Contact& c) {
  if (c.coupling >= 0 || profile.obstacles[c.obstacle].curvature() != 0.0) return 0.0;
  const Piece& beside =
      profile.pieces[c.joint < static_cast<int>(profile.pieces.size()) ? c.joint : c.joint - 1];
  return least_curvature * std::max(c.force, 0.0) / std::sqrt(beside.n.col(0).norm());
}

/// What the touch of the last event, its curvature, carries beside it.
void add_dip(const Profile& profile, const chain::Strands& strands, const Contact& c, bool meets,
             std::vector<ContactEvent>& events) {
  ContactEvent event{Kind::dip, c.joint, 1.0, c.s};
  event.redrawn = true;
  if (const auto dip = meets ? std::nullopt : dip_beside_touch(profile, strands, c)) {
    events.back().passes = true;
    events.back().presses = event.presses = dip->presses;
    event.value = 1.0 - dip->nearer / carried_between_strands;
    event.from = c.s - 0.5 * dip->length, event.to = c.s + 0.5 * dip->length;
  }
  events.push_back(event);
}

/// Strands that come near each other. Those of a line of theirs count as one link: where it is nearest.
std::vector<ContactEvent> approach_events(const Profile& profile, const Topology& topology,
                                          const chain::Strands& strands) {
  std::vector<ContactEvent> events;
  for (const chain::Approach& near : chain::approaches(profile, topology)) {
    ContactEvent event{Kind::approach, near.link, near.distance - 2.0 * profile.radius, near.s};
    event.other = near.other;
    event.mirrored = near.mirrored;
    event.s_other = near.s_other;
    const int line = strands.line_along(near.link), other_line = strands.line_along(near.other);
    const auto name = [&](int link, int of) { return of >= 0 ? strands.lines()[of].first.front() : link; };
    event.named = name(near.link, line), event.named_other = name(near.other, other_line);
    if (const auto* faced = strands.facing(near.link, near.other, near.mirrored); faced && faced->line >= 0) {
      const chain::StrandLine& all = strands.lines()[faced->line];
      event.named = std::max(all.first.front(), std::min(all.second.front(), all.second.back()));
      event.named_other = all.first.front();
      event.value = 1.0 + std::min(event.value, 0.0) / carried_between_strands;
      event.redrawn = true;
    }
    if (const auto* faced = strands.facing(near.link, near.other, near.mirrored);
        faced && faced->line < 0 &&
        (strands.line_of(faced->begin) >= 0 || strands.line_of(faced->end) >= 0)) {
      event.value += carried_between_strands;  // as in the line beside it
      event.redrawn = strands.opened_middle(*faced);
    }
    const auto same = std::find_if(events.begin(), events.end(), [&](const ContactEvent& other) {
      return other.named == event.named && other.named_other == event.named_other &&
             other.mirrored == event.mirrored;
    });
    if (same == events.end())
      events.push_back(event);
    else if (event.value < same->value)
      *same = event;
  }
  return events;
}

/// An arc beside a touch of strands that has no length left, as at the event itself, says nothing of the touches at its ends:
/// that it gives way comes first.
void heed_first_what_vanishes(std::vector<ContactEvent>& events, const Topology& topology,
                              const chain::Strands& strands) {
  const std::vector<int> gone = vanished_beside_strands(events, topology);
  const auto says_nothing = [&](const ContactEvent& event) {
    if (event.kind != Kind::curvature && event.kind != Kind::reaction) return false;
    const int partner = strands.partner(event.place);
    return std::any_of(gone.begin(), gone.end(), [&](int link) {
      const auto ends = [&](int joint) { return joint == link || joint == link + 1; };
      return ends(event.place) || (partner >= 0 && ends(partner));
    });
  };
  for (ContactEvent& event : events)
    if (says_nothing(event)) event.value = std::max(event.value, far);
}

}  // namespace

std::string ContactEvent::name() const {
  static const char* const words[] = {"pressure", "suction",  "length",   "force",    "curvature",
                                      "graze",    "buckling", "approach", "reaction", "rim",
                                      "dip",      "slope",    "room"};
  const std::string name =
      std::string(words[static_cast<int>(kind)]) + " " + std::to_string(named < 0 ? place : named);
  if (kind == Kind::approach)
    return name + " to " + std::to_string(named < 0 ? other : named_other) + (mirrored ? "'" : "");
  return obstacle == 0 ? name : name + ":" + std::to_string(obstacle + 1);
}

std::optional<double> value_of(const std::vector<ContactEvent>& events, const std::string& name) {
  for (const ContactEvent& event : events)
    if (event.name() == name) return event.value;
  return std::nullopt;
}

std::vector<int> vanished_beside_strands(const std::vector<ContactEvent>& events, const Topology& topology) {
  std::vector<int> links;
  for (const ContactEvent& event : events)
    if (event.kind == Kind::length && !event.redrawn && event.value <= 0.0 &&
        topology.beside_strand(event.place))
      links.push_back(event.place);
  return links;
}

std::vector<ContactEvent> contact_events(const Profile& profile, const Topology& topology) {
  std::vector<ContactEvent> events;
  const chain::Strands strands(topology);
  const int count = static_cast<int>(profile.pieces.size());
  const std::optional<ContactEvent> room = room_event(profile);
  for (int i = 0; i < count; ++i) {
    const Piece& piece = profile.pieces[i];
    const bool at_mid = topology.half && i == 0 && !topology.mid_touch;
    if (piece.weld) {
      events.push_back(length_event(profile, topology, strands, i));
      continue;
    }
    if (piece.stretch == Stretch::line && presses_at_ends_only(profile, piece)) {
      events.push_back({Kind::pressure, i, far, piece.s(0)});
    } else if (piece.stretch == Stretch::line) {
      const auto found = pressure_and_suction(piece, i, at_mid, presses_on(profile, i));
      events.insert(events.end(), found.begin(), found.end());
    }
    events.push_back(length_event(profile, topology, strands, i));
    if (piece.stretch == Stretch::line)
      events.push_back({Kind::buckling, i, piece.buckling.value_or(far), piece.s(0)});
    else
      for (int o = 0; o < profile.obstacles.size(); ++o)
        if (!lies_flat(profile, topology, i, o) && !(room && is_plate(profile.obstacles, o)))
          events.push_back(graze(profile, topology, o, i, at_mid));
  }
  if (room) events.push_back(*room);
  const std::vector<ContactEvent> ends = end_events(profile, topology);
  events.insert(events.end(), ends.begin(), ends.end());
  const std::vector<chain::Coupling> couplings = topology.couplings();
  for (const Contact& c : profile.contacts) {
    if (c.coupling >= 0 && c.joint != couplings[c.coupling].first) continue;  // one event for the two joints
    events.push_back({Kind::force, c.joint,
                      c.force + c.layer + (c.coupling < 0 ? 0.0 : carried_pull(profile, strands, c)), c.s});
    events.back().redrawn = strands.inside_line(c.joint);
    const auto on_rim = c.obstacle < 0 ? nullptr : obstacle::as_rim(profile.obstacles.pointer(c.obstacle));
    if (on_rim || (c.obstacle >= 0 && std::isfinite(profile.obstacles[c.obstacle].outer_radius())))
      events.push_back(rim_event(profile, c));
    // In a plate the reaction is that force itself.
    if (c.reaction && !topology.touches_flat(c.joint)) events.push_back(reaction_event(profile, c));
    // Of a line between strands g'' = 0.
    if (c.edge || strands.line_of(c.joint) >= 0 || before_flat_tail(profile, topology, c)) continue;
    if (on_rim && on_rim->tube() == 0.0) continue;  // it is passed at an angle
    const double bend = c.gap_curvature - least_curvature_at(profile, c);
    const bool meets = about_to_meet(profile, strands, c);
    events.push_back({Kind::curvature, c.joint, meets ? 1.0 : bend, c.s});
    if (c.coupling >= 0) add_dip(profile, strands, c, meets, events);
  }
  const std::vector<ContactEvent> near = approach_events(profile, topology, strands);
  events.insert(events.end(), near.begin(), near.end());
  heed_first_what_vanishes(events, topology, strands);
  return events;
}

}  // namespace windlass::equilibrium
