#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// Value of an event that is nowhere near: no local minimum of the gap, say.
constexpr double far = 1.0;

struct Least {
  double value, s;
};

/// Least value of a sampled quantity between the neighbours of sample k, on the polynomials of the elements there: an
/// event located by samples would move with the mesh.
Least least_near(const Piece& piece, const Eigen::VectorXd& values, Eigen::Index k) {
  constexpr int bits = 26;  // half of a double: a minimum is flat
  Least least{values(k), piece.s(k)};
  for (const Eigen::Index from : {k - 1, k}) {
    if (from < 0 || from + 1 >= values.size()) continue;
    const Eigen::Index first = from / piece.stride * piece.stride;
    const Eigen::VectorXd nodes = piece.s.segment(first, piece.stride + 1);
    const double begin = nodes(0), length = nodes(piece.stride) - begin;
    const Eigen::VectorXd scaled = (nodes.array() - begin) / length;
    const auto polynomial = [&](double x) {
      return bvp::lagrange_basis(scaled, x).dot(values.segment(first, piece.stride + 1));
    };
    const auto [x, value] = boost::math::tools::brent_find_minima(polynomial, scaled(from - first),
                                                                  scaled(from + 1 - first), bits);
    if (value < least.value) least = {value, begin + length * x};
  }
  return least;
}

/// Least local minimum of the gap to an obstacle inside a free arc. Next to a contact the gap is flat and its samples are
/// rounding; a minimum must stand out by more than that.
ContactEvent graze(const Profile& profile, int obstacle, int link, bool starts_at_mid) {
  constexpr double noise = 1e-11;
  const Piece& piece = profile.pieces[link];
  const obstacle::Surface& surface = profile.obstacles[obstacle];
  const auto at = [&](double value, double s) { return ContactEvent{Kind::graze, link, value, s, obstacle}; };
  ContactEvent event = at(far, piece.s(0));
  const Eigen::Index count = piece.s.size();
  Eigen::VectorXd g(count);
  for (Eigen::Index k = 0; k < count; ++k) g(k) = surface.gap(piece.r.col(k));
  if (starts_at_mid && g(0) < g(1)) event = at(g(0), piece.s(0));
  for (Eigen::Index k = 1; k + 1 < count; ++k) {
    if (g(k) > g(k - 1) - noise || g(k) > g(k + 1)) continue;
    const Least least = least_near(piece, g, k);
    if (least.value < event.value) event = at(least.value, least.s);
  }
  return event;
}

/// A line that carries no pressure over its length is no less in contact for that; see rod::buckling_margin.
ContactEvent least_pressure(const Piece& piece, int link) {
  if (piece.buckling) return {Kind::pressure, link, far, piece.s(0)};
  Eigen::Index k = 0;
  piece.p.minCoeff(&k);
  const Least least = least_near(piece, piece.p, k);
  return {Kind::pressure, link, least.value, least.s};
}

double length_of(const Piece& piece) { return piece.s(piece.s.size() - 1) - piece.s(0); }

/// Two touches at the ends of a short gap: with it their curvature, its height and all that tells them apart vanishes.
bool hardly_apart(const Profile& profile, int link) {
  constexpr double short_gap = 0.02, flat = 1e-6;
  if (profile.pieces[link].stretch != Stretch::gap ||
      length_of(profile.pieces[link]) > short_gap * profile.unit_length)
    return false;
  int touches = 0;
  for (const Contact& c : profile.contacts)
    touches += !c.edge && (c.joint == link || c.joint == link + 1) && c.gap_curvature < flat;
  return touches == 2;
}

ContactEvent length_event(const Profile& profile, int i) {
  const double least = least_length * profile.unit_length;
  ContactEvent event{Kind::length, i, length_of(profile.pieces[i]) - least, profile.pieces[i].s(0)};
  event.imminent = hardly_apart(profile, i);
  return event;
}

}  // namespace

std::string ContactEvent::name() const {
  static const char* const words[] = {"pressure", "length", "force", "curvature", "graze", "buckling"};
  const std::string name = std::string(words[static_cast<int>(kind)]) + " " + std::to_string(place);
  return obstacle == 0 ? name : name + ":" + std::to_string(obstacle + 1);
}

std::vector<ContactEvent> contact_events(const Profile& profile, const Topology& topology) {
  std::vector<ContactEvent> events;
  const int count = static_cast<int>(profile.pieces.size());
  for (int i = 0; i < count; ++i) {
    const Piece& piece = profile.pieces[i];
    const bool at_mid = topology.half && i == 0;
    if (piece.stretch == Stretch::line) events.push_back(least_pressure(piece, i));
    if (piece.stretch != Stretch::tail) events.push_back(length_event(profile, i));
    if (piece.stretch == Stretch::line)
      events.push_back({Kind::buckling, i, piece.buckling.value_or(far), piece.s(0)});
    else
      for (int o = 0; o < profile.obstacles.size(); ++o)
        events.push_back(graze(profile, o, i, at_mid && !topology.mid_touch));
  }
  for (const Contact& c : profile.contacts) {
    events.push_back({Kind::force, c.joint, c.force, c.s});
    if (!c.edge) events.push_back({Kind::curvature, c.joint, c.gap_curvature, c.s});
  }
  return events;
}

}  // namespace windlass::equilibrium
