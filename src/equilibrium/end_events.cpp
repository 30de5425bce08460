#include "end_events.hpp"

#include <algorithm>
#include <cmath>

#include "rim_events.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Eigen::Vector3d;
using Kind = ContactEvent::Kind;

namespace {

/// Slope of an end towards a plate, and the plate's force over the pull, below which what is between the end's touch and that of the
/// tail beside it is a stretch of the branch that its steps do not resolve: a length of the rod times this, in the plate's height.
constexpr double nearly_level = 1e-6;

/// One of the two ends of a rod on a full chain.
struct RodEnd {
  double s;
  Vector3d r, outward,
      force;  ///< outward: its tangent away from the rod; force: what acts on it from outside
};

RodEnd end_of(const Profile& profile, bool right) {
  const Piece& tail = right ? profile.pieces.back() : profile.pieces.front();
  const Eigen::Index at = right ? tail.s.size() - 1 : 0;
  const double side = right ? 1.0 : -1.0;
  return {tail.s(at), tail.r.col(at), side * rod::directors(tail.q.col(at)).col(2), side * tail.n.col(at)};
}

/// How much the rod comes nearer to a plate towards its end, a length.
double approach(const Profile& profile, const RodEnd& end, int obstacle) {
  return -profile.obstacles[obstacle].normal(end.r).dot(end.outward);
}

int joint_of_end(const Topology& topology, bool right) {
  return right ? static_cast<int>(topology.stretches.size()) : 0;
}

std::vector<int> plates(const obstacle::Set& obstacles) {
  std::vector<int> out;
  for (int o = 1; o < obstacles.size(); ++o)
    if (is_plate(obstacles, o)) out.push_back(o);
  return out;
}

/// The section of a rod that is nearest to a plate.
struct Nearest {
  int link = 0;
  double s = 0.0, gap = HUGE_VAL;
  bool at_begin = false, at_end = false;  ///< of the rod
};

Nearest nearest_to(const Profile& profile, int obstacle) {
  Nearest out;
  const int last = static_cast<int>(profile.pieces.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const Piece& piece = profile.pieces[i];
    const Eigen::Index count = piece.s.size();
    Eigen::VectorXd g(count);
    for (Eigen::Index k = 0; k < count; ++k) g(k) = profile.obstacles[obstacle].gap(piece.r.col(k));
    Eigen::Index at = 0;
    Least least{g.minCoeff(&at), piece.s(at)};
    if (at > 0 && at + 1 < count)
      least = least_near(piece, g, piece.s(at), least.value, piece.s(at - 1), piece.s(at + 1));
    if (least.value < out.gap)
      out = {i, least.s, least.value, i == 0 && at == 0, i == last && at + 1 == count};
  }
  return out;
}

}  // namespace

bool is_plate(const obstacle::Set& obstacles, int obstacle) {
  return obstacle > 0 && obstacles[0].slips() && obstacles[obstacle].curvature() == 0.0;
}

int image_of(const Profile& profile, int obstacle) {
  if (!profile.stands_free || obstacle <= 0) return obstacle;
  const std::vector<int> both = plates(profile.obstacles);
  if (both.size() != 2) return obstacle;
  const int beyond = obstacle - (obstacle < both[1] ? both[0] : both[1]);  // 1: an outer edge
  const int image = (obstacle < both[1] ? both[1] : both[0]) + beyond;
  return image < profile.obstacles.size() && is_plate(profile.obstacles, image) == (beyond == 0) ? image
                                                                                                 : obstacle;
}

std::optional<Least> graze_at_end(const Profile& profile, const Topology& topology, int obstacle, int link) {
  constexpr double level = 1e-9;  // a tail that lies in the plate, or is straight long before its end
  const bool right = link + 1 == static_cast<int>(profile.pieces.size());
  if (profile.ends_held || !is_plate(profile.obstacles, obstacle)) return std::nullopt;
  if (topology.half ? !right : !right && link != 0) return std::nullopt;
  if (!std::isfinite(profile.pieces[link].s.sum())) return std::nullopt;
  std::optional<Least> out;
  for (const bool at_right : {false, true}) {
    if (at_right ? !right : link != 0 || topology.half) continue;
    if (topology.end_touches(joint_of_end(topology, at_right)) == obstacle) continue;
    const RodEnd end = end_of(profile, at_right);
    if (!(approach(profile, end, obstacle) > level) ||
        !(inside_rim(profile.obstacles[obstacle], end.r) > 0.0))
      continue;
    const double gap = profile.obstacles[obstacle].gap(end.r);
    if (!out || gap < out->value) out = Least{gap, end.s};
  }
  return out;
}

std::vector<ContactEvent> end_events(const Profile& profile, const Topology& topology) {
  std::vector<ContactEvent> out;
  for (const bool right : {false, true}) {
    const int joint = joint_of_end(topology, right), plate = topology.end_touches(joint);
    if (plate <= 0) continue;
    const RodEnd end = end_of(profile, right);
    // The pull is normal to the axis: all along it is the plate's.
    out.push_back({Kind::force, joint, profile.obstacles[plate].normal(end.r).dot(end.force), end.s});
    out.push_back({Kind::slope, joint, approach(profile, end, plate), end.s});
    if (std::isfinite(profile.obstacles[plate].outer_radius()))
      out.push_back({Kind::rim, joint, inside_rim(profile.obstacles[plate], end.r), end.s});
  }
  return out;
}

std::optional<ContactEvent> room_event(const Profile& profile) {
  const std::vector<int> both = profile.floats ? plates(profile.obstacles) : std::vector<int>();
  if (both.size() != 2) return std::nullopt;
  double room = 0.0;  // gaps of any one place: the distance of the plates
  for (const int plate : both) room += profile.obstacles[plate].gap(Vector3d::Zero());
  ContactEvent event{Kind::room, 0, room - extent_in_z(profile), profile.begin()};
  return event;
}

void centre_between_plates(Profile& profile) {
  const std::vector<int> both = profile.floats ? plates(profile.obstacles) : std::vector<int>();
  if (both.size() != 2) return;
  const double first = nearest_to(profile, both[0]).gap, second = nearest_to(profile, both[1]).gap;
  const double lift = 0.5 * (first - second) * profile.obstacles[both[1]].normal(Vector3d::Zero()).z();
  for (Piece& piece : profile.pieces) piece.r.row(2).array() += lift;
  for (chain::Contact& c : profile.contacts) c.r.z() += lift, c.z += lift;
}

bool is_end(const Strip& strip, int joint) {
  return joint + 1 == static_cast<int>(strip.s.size()) || (joint == 0 && !strip.half);
}

namespace {

/// The touch of an end, a little further in. What is beyond begins at the end.
Successor moved_inward(const Strip& strip, bool right) {
  constexpr double length = 0.05;
  Strip next = strip;
  chain::Seat& end = right ? next.on.back() : next.on.front();
  const chain::Seat plate = end;
  end = {};
  const int tail = right ? static_cast<int>(strip.parts.size()) - 1 : 0;
  if (right)
    next.split(tail, strip.s.back() - length, Stretch::gap, Stretch::tail, plate);
  else
    next.split(tail, strip.s.front() + length, Stretch::tail, Stretch::gap, plate);
  next.parts[right ? tail + 1 : tail].fresh = true;
  return next.successor();
}

}  // namespace

std::optional<Successor> end_touches(const ContactEvent& event, const Profile& profile, const Strip& strip) {
  const bool right = event.s == strip.s.back();
  if (!right && (strip.half || event.s != strip.s.front())) return std::nullopt;
  Strip touched = strip;
  (right ? touched.on.back() : touched.on.front()) = chain::Seat{event.obstacle};
  if (approach(profile, end_of(profile, right), event.obstacle) < nearly_level)
    return moved_inward(touched, right);
  return touched.successor();
}

std::vector<Successor> touches_both(const Profile& profile, const Strip& strip) {
  Strip next = strip;
  std::vector<Nearest> all;
  for (const int plate : plates(profile.obstacles)) {
    const Nearest here = nearest_to(profile, plate);
    if (here.at_begin && !strip.half)
      next.on.front() = chain::Seat{plate};
    else if (here.at_end)
      next.on.back() = chain::Seat{plate};
    else if (strip.is_line(here.link))
      return {};
    else
      next.cut(next.part_at(here.s), here.s, chain::Seat{plate});
  }
  return {next.successor()};
}

std::vector<Successor> touch_leaves_end(const ContactEvent& event, const Strip& strip) {
  return {moved_inward(strip, event.place != 0)};
}

std::optional<Successor> touch_reaches_end(int tail, const Profile& profile, const Strip& strip) {
  const bool right = tail > 0;
  const int last = static_cast<int>(strip.parts.size()) - 1, touch = right ? last : 1;
  const chain::Seat plate = strip.on[touch];
  if (profile.ends_held || strip.half || last < 1 || plate.strand != 0 || plate.flat >= 0 ||
      !is_plate(profile.obstacles, plate.obstacle) || strip.is_line(right ? last - 1 : 1))
    return std::nullopt;
  const chain::Contact* here = profile.contact_at(touch);
  const double pull = profile.pieces[tail].n.col(0).norm();
  Strip next = strip;
  next.erase(tail, touch);
  (right ? next.parts.back() : next.parts.front()).kind = Stretch::tail;
  if (here && here->force < nearly_level * pull)
    float_where_one_is_left(profile, next);
  else
    (right ? next.on.back() : next.on.front()) = plate;
  return next.successor();
}

void float_where_one_is_left(const Profile& profile, Strip& strip) {
  if (!profile.stands_free) return;
  std::vector<int> touched;
  for (int j = 0; j < static_cast<int>(strip.s.size()); ++j) {
    const int obstacle = strip.on[j].obstacle;
    if (strip.on[j].strand == 0 && is_plate(profile.obstacles, obstacle) &&
        std::find(touched.begin(), touched.end(), obstacle) == touched.end())
      touched.push_back(obstacle);
  }
  if (plates(profile.obstacles).size() != 2 || touched.size() != 1) return;
  for (int j = static_cast<int>(strip.s.size()); j-- > 0;) {
    if (strip.on[j].obstacle != touched.front() || strip.on[j].strand != 0) continue;
    if (is_end(strip, j))
      strip.on[j] = {};
    else if (!strip.is_line(j - 1) && !strip.is_line(j))
      strip.merge(j - 1, j, chain::Stretch(joined(strip.parts[j - 1].kind, strip.parts[j].kind)));
  }
}

}  // namespace windlass::equilibrium
