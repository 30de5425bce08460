#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <cmath>

#include "dense_samples.hpp"
#include "end_events.hpp"
#include "graze_event.hpp"
#include "length_event.hpp"
#include "lies_flat.hpp"
#include "line_pressure.hpp"
#include "rim_events.hpp"
#include "strand_line_events.hpp"
#include "touch_dip.hpp"
#include "windlass/chain/self_distance.hpp"
#include "windlass/obstacle/rim.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// A rod without torsion that lies on a plate beside a cylinder presses on it at the ends of the line only: between them its
/// pressure is rounding.
bool presses_at_ends_only(const Profile& profile, const Piece& line) {
  constexpr double rounding = 1e-9;
  return profile.obstacles[0].curvature() != 0.0 && profile.obstacles[line.obstacle].curvature() == 0.0 &&
         line.p.cwiseAbs().maxCoeff() < rounding;
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
    event.value = 1.0 - dip->part;
    event.from = dip->from, event.to = dip->to;
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
    if (event.kind == Kind::length && event.value <= 0.0 && topology.beside_strand(event.place))
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
