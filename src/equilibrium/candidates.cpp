#include "candidates.hpp"

#include <utility>

#include "end_events.hpp"
#include "line_touches.hpp"
#include "obstacle_candidates.hpp"
#include "opened_press.hpp"
#include "plate_successors.hpp"
#include "strand_candidates.hpp"
#include "strand_line_events.hpp"
#include "strand_successors.hpp"
#include "touch_dip.hpp"

namespace windlass::equilibrium {

using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

std::vector<Successor> after_vanished_length(const ContactEvent& event, const Profile& profile,
                                             const Topology& topology, const Strip& strip) {
  if (profile.pieces[event.place].stretch == Stretch::tail) {
    if (const auto next = touch_reaches_end(event.place, profile, strip)) return {*next};
    return {end_of_rod(strip)};
  }
  if (const auto opened = opened_press(profile, topology, event.place); opened && event.redrawn)
    return {closed_under_press(*opened, strip)};
  if (auto flat = flat_line_begins_or_ends(event.place, profile, strip); !flat.empty()) return flat;
  if (const auto fewer = line_with_fewer_touches(profile, topology, event.place, strip)) return {*fewer};
  if (const auto anew = laid_anew_at(profile, chain::Strands(topology), event.place); anew && event.redrawn)
    return laid_anew(*anew, profile, topology, strip);
  if (event.redrawn && part_of_carried(profile, chain::Strands(topology), event.place))
    return become_one(event.place, profile, topology, strip);
  if (event.redrawn && part_of_opened(profile, chain::Strands(topology), event.place))
    if (const auto one = lines_unite(event.place, profile, topology, strip)) return {*one};
  return after_skeleton(event, profile, topology, strip);
}

std::vector<Successor> after_lost_force(const ContactEvent& event, const Profile& profile,
                                        const Topology& topology, const Strip& strip) {
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
}

std::vector<Successor> after_approach(const ContactEvent& event, const Profile& profile,
                                      const Topology& topology, const Strip& strip) {
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
      return after_vanished_length(event, profile, topology, strip);
    case Kind::force:
      return after_lost_force(event, profile, topology, strip);
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
      return after_approach(event, profile, topology, strip);
  }
  return {};
}

}  // namespace windlass::equilibrium
