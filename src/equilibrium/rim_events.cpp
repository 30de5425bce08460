#include "rim_events.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "line_pressure.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using Kind = ContactEvent::Kind;

double inside_rim(const obstacle::Surface& surface, const Eigen::Vector3d& r) {
  return surface.outer_radius() - r.head<2>().norm();
}

ContactEvent graze_of_rim(const Profile& profile, const obstacle::Rim& rim, int obstacle, int link) {
  constexpr double rises = 1e-9;
  const Piece& piece = profile.pieces[link];
  ContactEvent event{Kind::graze, link, far, piece.s(0)};
  event.obstacle = obstacle;
  const auto at = [&](double s) {
    const Profile::At here = profile.at(s);
    return std::pair(rim.beside(here.r), rim.across(here.r, rod::directors(here.q).col(2)));
  };
  const auto slope = [&](double s) {  // of half the squared distance
    const auto [from, way] = at(s);
    return from.dot(way);
  };
  Eigen::Index first = 0, last = piece.s.size() - 1;
  for (const Contact& c : profile.contacts) {  // where it touches the edge it is nearest by that
    if (c.obstacle != obstacle) continue;
    first += c.joint == link;
    last -= c.joint == link + 1;
  }
  for (Eigen::Index k = first; k < last; ++k) {
    if (!(slope(piece.s(k)) < 0.0 && slope(piece.s(k + 1)) >= 0.0)) continue;
    std::uintmax_t most = 60;
    const auto [low, high] = boost::math::tools::toms748_solve(
        slope, piece.s(k), piece.s(k + 1), boost::math::tools::eps_tolerance<double>(44), most);
    const double s = 0.5 * (low + high);
    const auto [from, way] = at(s);
    const double outward = way(0) < 0.0 ? -1.0 : 1.0;  // the way towards the end of the rod
    if (!(-outward * way(1) > rises)) continue;
    const double distance = outward * (way(0) * from(1) - way(1) * from(0)) / way.norm() - rim.tube();
    if (distance < event.value) event.value = distance, event.s = s;
  }
  return event;
}

ContactEvent rim_event(const Profile& profile, const Contact& c) {
  const auto rim = obstacle::as_rim(profile.obstacles.pointer(c.obstacle));
  if (!rim) return {Kind::rim, c.joint, inside_rim(profile.obstacles[c.obstacle], c.r), c.s};
  const Eigen::Vector2d way = rim->across(c.r, c.normal);  // (sin α, cos α)
  ContactEvent event{Kind::rim, c.joint, way(0) * way(1), c.s};
  event.obstacle = c.obstacle;
  return event;
}

}  // namespace windlass::equilibrium
