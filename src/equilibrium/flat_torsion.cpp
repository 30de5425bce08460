#include "flat_torsion.hpp"

#include <cmath>

#include "dragged_layout.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Stretch;
using Eigen::Vector3d;

namespace {

bool holds_spin(scene::EndKind end) { return end != scene::EndKind::moment_free; }

}  // namespace

bool lies_in_plate(const Topology& topology) {
  const int links = static_cast<int>(topology.stretches.size());
  for (int i = 0; i < links; ++i)
    if (topology.stretches[i] == Stretch::line && !topology.lies_flat(i)) return false;
  for (int j = topology.half && !topology.mid_touch ? 1 : 0; j <= links; ++j) {
    const bool contact = (j > 0 || topology.half) && j < links;
    const chain::Seat seat = topology.seat(j);
    if (seat.strand != 0 || seat.stop >= 0 || (!contact && topology.end_touches(j) > 0)) return false;
    if (contact && !topology.touches_flat(j) && !(topology.lies_flat(j) || topology.lies_flat(j - 1)))
      return false;
  }
  return topology.contact();
}

bool stays_in_plate(const Topology& topology, const scene::Scene& scene) {
  if (!scene.plate || std::isfinite(scene.plate->outer_radius)) return false;
  const bool both = holds_spin(scene.ends.left_kind()) && holds_spin(scene.ends.right_kind());
  const Topology whole = chain::unfolded(topology);
  for (std::size_t i = 1; i + 1 < whole.stretches.size(); ++i)
    if (whole.stretches[i] != Stretch::line && !both) return false;
  return true;
}

namespace {

/// One arc on its way to having its torsion.
struct Twisted {
  const scene::Scene& scene;
  ArcRecord& arc;

  Vector3d tangent(Eigen::Index k) const { return rod::directors(arc.q.col(k)).col(2); }
  double stretch(Eigen::Index k) const { return 1.0 + scene.rod.compliance() * arc.n.col(k).dot(tangent(k)); }
  /// θ'/λ, the curvature in the plane.
  double curvature(Eigen::Index k) const { return arc.m(2, k) / (scene.rod.bending_stiffness * stretch(k)); }
  /// Its rate along a free arc: B θ'' = −λ n_ν, λ' = θ' n_ν / EA, ν = e_z × t.
  double curvature_rate(Eigen::Index k) const {
    const double across = arc.n.col(k).dot(Vector3d::UnitZ().cross(tangent(k)));
    const double turn = arc.m(2, k) / scene.rod.bending_stiffness, along = stretch(k);
    return -across / scene.rod.bending_stiffness -
           turn * turn * scene.rod.compliance() * across / (along * along);
  }
  /// @param angle  about the tangent
  void twist(Eigen::Index k, double moment, double angle) {
    const Vector3d t = tangent(k);
    arc.n(2, k) = moment * curvature(k);
    arc.m.col(k) += moment * t;
    arc.q.col(k) =
        rod::product(arc.q.col(k), rod::Quaternion(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)));
  }
};

/// Presses a tail onto the plate with M θ''. @returns the force at its outer end, which nothing beyond takes
double press(Twisted tail, double moment, bool leftward) {
  ArcRecord& arc = tail.arc;
  const Eigen::Index last = arc.s.size() - 1;
  for (Eigen::Index k = 0; k <= last; ++k) arc.p(k) = moment * tail.curvature_rate(k);
  arc.kind = ArcKind::line;
  arc.obstacle = plate_obstacle;
  arc.force = arc.plate_force = moment * (tail.curvature(last) - tail.curvature(0));
  return std::abs(moment * tail.curvature(leftward ? 0 : last));
}

void press_end(JointRecord& end, double force) {
  end.obstacle = plate_obstacle;
  end.normal = -Vector3d::UnitZ();
  end.force = force;
}

}  // namespace

void add_flat_torsion(const scene::Scene& scene, Solution& out) {
  const double lever = scene.friction_arm() * *scene.friction, mu = *scene.friction;
  const double torsional_stiffness = scene.rod.twist_ratio * scene.rod.bending_stiffness;
  const bool left = holds_spin(scene.ends.left_kind()), right = holds_spin(scene.ends.right_kind());
  // M falls by the moment of all contacts from end to end; where both hold the spin the rod is twisted as much either way.
  double moment = lever * out.R_tot * (left && right ? 0.5 : left ? 1.0 : 0.0), angle = 0.0;
  std::vector<std::vector<std::pair<double, double>>> torsion;  // M and the turn at each sample
  for (std::size_t a = 0; a < out.arcs.size(); ++a) {
    const ArcRecord& arc = out.arcs[a];
    if (a > 0) moment -= lever * out.joints[a].force;
    torsion.emplace_back().emplace_back(moment, angle);
    for (Eigen::Index k = 1; k < arc.s.size(); ++k) {
      const double h = arc.s(k) - arc.s(k - 1), before = moment;
      moment -= lever * 0.5 * (arc.p(k - 1) + arc.p(k)) * h;
      angle += 0.5 * (before + moment) * h / torsional_stiffness;
      out.energy += (before * before + before * moment + moment * moment) * h / (6.0 * torsional_stiffness);
      torsion.back().emplace_back(moment, angle);
    }
  }
  const double free_turn = left ? 0.0 : angle;  // the end that holds the spin has none
  out.plate_force = 0.0;
  for (std::size_t a = 0; a < out.arcs.size(); ++a) {
    Twisted here{scene, out.arcs[a]};
    ArcRecord& arc = out.arcs[a];
    if (a > 0) {
      JointRecord& joint = out.joints[a];
      joint.plate_force = (mu - lever * here.curvature(0)) * joint.force;
      out.plate_force += joint.plate_force;
    }
    if (arc.kind == ArcKind::line) arc.plate_force = (mu - lever) * arc.force;
    const bool first = a == 0, last = a + 1 == out.arcs.size();
    const double tail_moment = torsion[a].front().first;
    if ((first || last) && arc.kind == ArcKind::free && tail_moment != 0.0) {
      const double end = press(here, tail_moment, first);
      if (!scene.ends.guided()) {
        press_end(first ? out.joints.front() : out.joints.back(), end);
        out.plate_force += end;
      }
    }
    out.plate_force += arc.plate_force;
    for (std::size_t k = 0; k < torsion[a].size(); ++k)
      here.twist(static_cast<Eigen::Index>(k), torsion[a][k].first, torsion[a][k].second - free_turn);
  }
}

}  // namespace windlass::equilibrium
