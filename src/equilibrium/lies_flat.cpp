#include "lies_flat.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;

bool lies_flat(const Profile& profile, const Topology& topology, int link, int obstacle) {
  for (const int joint : {link, link + 1})
    if (topology.touches_flat(joint) && topology.seat(joint).flat == obstacle) return true;
  const auto touched = [&](int joint) {
    return std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const Contact& c) {
      return c.joint == joint && c.coupling < 0 && !c.edge && c.obstacle == obstacle;
    });
  };
  const auto flat_line = [&](int line) {
    return topology.lies_flat(line) && topology.seat(line).flat == obstacle;
  };
  if ((flat_line(link - 1) && touched(link + 1)) || (flat_line(link + 1) && touched(link))) return true;
  constexpr double twisted = 1e-9;  // of the usual moment √T: a tail that carries torsion is not plane
  const Piece& tail = profile.pieces[link];
  if (tail.stretch != Stretch::tail || !profile.obstacles[0].slips() || obstacle == 0) return false;
  const double twist = tail.m.col(0).dot(rod::directors(tail.q.col(0)).col(2));
  if (std::abs(twist) > twisted * std::max(1.0, std::sqrt(tail.n.col(0).norm()))) return false;
  return std::any_of(profile.contacts.begin(), profile.contacts.end(), [&](const Contact& c) {
    return c.obstacle == obstacle && (c.joint == link || c.joint == link + 1);
  });
}

}  // namespace windlass::equilibrium
