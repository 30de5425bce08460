#include "strand_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "lies_flat.hpp"
#include "line_touches.hpp"
#include "obstacle_candidates.hpp"
#include "strand_successors.hpp"

namespace windlass::equilibrium {

using chain::Profile;
using chain::Topology;
using Kind = ContactEvent::Kind;

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

namespace {

/// Where two touches' forces together are: the part of the way from the first to the second.
double centre_of_forces(const Profile& profile, int first, int second) {
  const auto force = [&](int joint) { return std::max(profile.contact_at(joint)->force, 0.0); };
  const double one = force(first), two = force(second);
  return one + two > 0.0 ? two / (one + two) : 0.5;
}

}  // namespace

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

namespace {

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

}  // namespace

std::vector<Successor> laid_anew(const LaidAnew& here, const Profile& profile, const Topology& topology,
                                 const Strip& strip) {
  std::vector<Successor> out;
  if (here.middle >= 0)
    out = line_opens_about(here.middle, here.begin + here.end - here.middle, profile, topology, strip);
  if (here.pressed >= 0) out.push_back(end_takes_press(here, profile, topology, strip));
  out.push_back(with_touches(skeleton_of(strip).strip.successor(), profile, topology));
  return out;
}

bool opens_line(const ContactEvent& event, const Topology& topology) {
  const chain::Strands strands(topology);
  const chain::Strands::Facing* facing = strands.facing(event.place, event.other, event.mirrored);
  return facing && strands.opened_middle(*facing);
}

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

}  // namespace windlass::equilibrium
