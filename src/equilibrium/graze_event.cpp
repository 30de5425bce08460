#include "graze_event.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "dense_samples.hpp"
#include "end_events.hpp"
#include "lies_flat.hpp"
#include "line_pressure.hpp"
#include "rim_events.hpp"
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

}  // namespace

bool before_flat_tail(const Profile& profile, const Topology& topology, const Contact& c) {
  const int count = static_cast<int>(profile.pieces.size());
  return c.coupling < 0 && ((c.joint > 0 && lies_flat(profile, topology, c.joint - 1, c.obstacle)) ||
                            (c.joint < count && lies_flat(profile, topology, c.joint, c.obstacle)));
}

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

}  // namespace windlass::equilibrium
