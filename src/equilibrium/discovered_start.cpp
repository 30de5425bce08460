#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/equilibrium/discovery.hpp"
#include "windlass/obstacle/cylinder.hpp"

namespace windlass::equilibrium {

namespace {

/// Contacts of the half rod, from the mid-point outward, as a draft of its arcs.
Draft draft_of(const Discovery& found, double half_length) {
  Draft draft;
  draft.s.push_back(0.0);
  for (const NodalContact& contact : found.contacts) {
    const bool line = contact.kind == NodalContact::Kind::line;
    if (contact.s_begin > 0.0) {  // else it lies across the mid-point
      draft.right.push_back(chain::Stretch::gap);
      draft.s.push_back(contact.s_begin);
    } else if (!line) {
      draft.mid_touch = true;
    }
    if (line) {
      draft.right.push_back(chain::Stretch::line);
      draft.s.push_back(contact.s_end);
    }
  }
  draft.right.push_back(chain::Stretch::tail);
  draft.s.push_back(half_length);
  return draft;
}

/// The nodal rod as a curve. The force follows from the pull, contact by contact; the moment from the turn between nodes.
chain::Profile profile_of(const Discovery& found, const contact::Loads& loads) {
  const auto count = static_cast<Eigen::Index>(found.s.size());
  chain::Piece rod;
  rod.s = Eigen::Map<const Eigen::VectorXd>(found.s.data(), count);
  rod.heading = Eigen::Map<const Eigen::VectorXd>(found.theta.data(), count);
  rod.r.setZero(3, count);
  rod.n.setZero(3, count);
  rod.m.setZero(3, count);
  rod.q.resize(4, count);
  rod.angle.setZero(count);
  rod.p.setZero(count);
  rod.inclination.setZero(count);
  Eigen::Vector2d n =
      loads.tension * Eigen::Vector2d(std::cos(0.5 * loads.angle), std::sin(0.5 * loads.angle));
  for (Eigen::Index k = count; k-- > 0;) {
    const auto i = static_cast<std::size_t>(k);
    rod.r.col(k) << found.x[i], found.y[i], 0.0;
    rod.n.col(k) << n, 0.0;
    n += found.force[i] * obstacle::Cylinder().normal(rod.r.col(k)).head<2>();
    rod.q.col(k) = contact::spatial::surface_frame(rod.heading(k), 0.0, 0.0);
    const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0), after = std::min(k + 1, count - 1);
    rod.m(2, k) = (rod.heading(after) - rod.heading(before)) / (rod.s(after) - rod.s(before));
  }
  for (Eigen::Index k = 1; k < count; ++k) {
    const double turn = obstacle::Cylinder::angle(rod.r.col(k));
    rod.angle(k) = rod.angle(k - 1) + std::remainder(turn - rod.angle(k - 1), 2.0 * M_PI);
  }
  chain::Profile out;
  out.pieces.push_back(rod);
  return out;
}

}  // namespace

std::optional<Started> discovered_start(const scene::Scene& scene, bool spatial, bool half,
                                        const std::vector<std::string>& keys) {
  contact::Loads loads = loads_of(scene);
  if (scene.rod.infinite()) loads.half_length = 0.5 * loads.angle + 40.0 / std::sqrt(loads.tension);
  DiscoveryOptions options;
  options.clamped = scene.ends.kind == scene::EndKind::clamped;
  const Discovery found = discover_contacts(loads, options);
  if (!found.converged || found.contacts.empty()) return std::nullopt;
  const Draft draft = draft_of(found, loads.half_length);
  std::optional<Started> planar =
      attempt(scene, false, half || spatial, keys, draft, profile_of(found, loads));
  if (!planar || !spatial) return planar;
  return lift(*planar->problem, planar->x, planar->p, half);
}

}  // namespace windlass::equilibrium
