#include "record_drag.hpp"

#include <algorithm>
#include <cmath>

#include "flat_torsion.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using Eigen::Vector3d;

namespace {

/// Arclengths of the joints of the whole rod.
std::vector<double> places_of(const RodProblem& problem, const Vector& x, const contact::Loads& loads) {
  const chain::Chain& chain = problem.chain();
  const Topology& topology = problem.topology();
  std::vector<double> out;
  for (int j = chain.joint_count(); topology.half && j-- > 1;) out.push_back(-chain.arclength(x, loads, j));
  const bool spanned = topology.half && !topology.mid_touch;  // the middle is no joint
  for (int j = spanned ? 1 : 0; j < chain.joint_count(); ++j) out.push_back(chain.arclength(x, loads, j));
  return out;
}

/// Of each arc of the record, its link in the whole rod: what vanishes at an event has none.
std::vector<int> links_of(const Solution& state, const std::vector<double>& places) {
  std::vector<int> out;
  int link = 0;
  for (const ArcRecord& arc : state.arcs) {
    while (link + 2 < static_cast<int>(places.size()) &&
           (places[link] != arc.s_begin || places[link + 1] != arc.s_end))
      ++link;
    out.push_back(link++);
  }
  return out;
}

/// Does an arc of the record begin where cylinder and plate hold the rod at once?
bool begins_flat(const Topology& topology, const std::vector<int>& links, std::size_t k) {
  return topology.lies_flat(links[k]) || (k > 0 && topology.lies_flat(links[k - 1])) ||
         topology.touches_flat(links[k]);
}

/// Speed of the rod along itself at a joint, over that of the cylinder: ω times its stretch, the mean of the two sides.
double speed_at(const Solution& state, std::size_t joint, double compliance) {
  if (compliance == 0.0) return state.travel_rate;
  const ArcRecord &before = state.arcs[joint - 1], &after = state.arcs[joint];
  const Vector3d n = 0.5 * (before.n.rightCols<1>() + after.n.col(0));
  return state.travel_rate * (1.0 + compliance * n.dot(rod::directors(after.q.col(0)).col(2)));
}

/// What another strand pushes a joint with.
Vector3d push_of_strand(const Solution& state, const JointRecord& joint) {
  return joint.partner < 0 ? Vector3d::Zero() : Vector3d(joint.strand_force * strand_direction(state, joint));
}

/// mu N d_z of the contacts where the rod lies on a plate, too: it takes the friction on the spot. @returns the sum
double drag_on_plate(Solution& state, const Topology& topology, const std::vector<int>& links,
                     double friction, double compliance) {
  const auto up = [&](double speed) { return friction / std::sqrt(1.0 + speed * speed); };
  const double upward = up(state.travel_rate);
  double sum = 0.0;
  for (std::size_t k = 0; k < state.arcs.size(); ++k) {
    ArcRecord& arc = state.arcs[k];
    JointRecord& joint = state.joints[k];
    if (topology.lies_flat(links[k])) arc.plate_force = upward * arc.force;
    const bool flat = begins_flat(topology, links, k);
    if (flat && joint.obstacle == 0)
      joint.plate_force = (k > 0 ? up(speed_at(state, k, compliance)) : upward) * joint.force;
    sum += arc.plate_force + joint.plate_force;
  }
  return sum;
}

/// What strands push lines with that lie on cylinder and plate, or their edges at an event, along the axis: it goes straight to the
/// plate. @returns the sum
double push_on_plate(Solution& state, const Topology& topology, const std::vector<int>& links) {
  double sum = 0.0;
  for (std::size_t k = 1; k < state.arcs.size(); ++k) {
    JointRecord& joint = state.joints[k];
    if (joint.obstacle != 0 || !(topology.lies_flat(links[k - 1]) || topology.lies_flat(links[k]))) continue;
    const double push = push_of_strand(state, joint)(2);
    joint.plate_force += push;
    sum += push;
  }
  return sum;
}

/// mu N d_z of the other contacts: what they take of the force along the axis.
double axial_drag(const Solution& state, const Topology& topology, const std::vector<int>& links) {
  double sum = 0.0;
  for (std::size_t k = 0; k < state.arcs.size(); ++k) {
    if (topology.lies_flat(links[k])) continue;
    const ArcRecord& arc = state.arcs[k];
    if (arc.kind == ArcKind::line && arc.obstacle == 0) sum += arc.n(2, 0) - arc.n(2, arc.n.cols() - 1);
    const JointRecord& joint = state.joints[k];
    if (k == 0 || begins_flat(topology, links, k) || joint.obstacle != 0) continue;
    const ArcRecord& before = state.arcs[k - 1];
    sum += before.n(2, before.n.cols() - 1) - arc.n(2, 0) - push_of_strand(state, joint)(2);
  }
  return sum;
}

}  // namespace

void measure_drag(Solution& out, double friction, double compliance) {
  out.invariants.hamiltonian_drift = out.invariants.force_residual = 0.0;
  if (out.travel_rate != 0.0) out.invariants.axial_torque_drift = 0.0;
  for (std::size_t k = 1; k + 1 < out.joints.size(); ++k) {
    const JointRecord& joint = out.joints[k];
    const ArcRecord &before = out.arcs[k - 1], &after = out.arcs[k];
    const Vector3d t = rod::directors(after.q.col(0)).col(2);
    Vector3d force = joint.force * joint.normal + push_of_strand(out, joint);
    if (joint.obstacle == 0)
      force += joint.force * friction * (Vector3d::UnitZ() - speed_at(out, k, compliance) * t).normalized();
    const Vector3d rest = before.n.rightCols<1>() - after.n.col(0) - force;
    out.invariants.force_residual = std::max(out.invariants.force_residual, rest.head<2>().norm());
  }
}

void record_drag(const RodProblem& problem, const Vector& x, const contact::Loads& loads,
                 const scene::Scene& scene, Solution& out) {
  if (!scene.slides()) return;
  out.dragged = true;
  if (!problem.spatial()) {
    // Flat, the rod lies on the plate wherever it touches the cylinder, and the plate takes the friction there.
    out.plate_force = *out.F0;
    for (ArcRecord& arc : out.arcs) {
      arc.r.row(2).array() += scene.plate->height;
      arc.plate_force = *scene.friction * arc.force;
    }
    for (JointRecord& joint : out.joints) {
      joint.r(2) += scene.plate->height, joint.z += scene.plate->height;
      joint.plate_force = *scene.friction * joint.force;
    }
    if (scene.friction_arm() > 0.0) add_flat_torsion(scene, out);
    return;
  }
  const double travelled = problem.chain().travelled(x);
  (scene.ends.travel == scene::Travel::free ? out.travel_rate : out.pull_difference) = travelled;
  const std::vector<int> links = links_of(out, places_of(problem, x, loads));
  const Topology whole = chain::unfolded(problem.topology());
  const double on_plate = drag_on_plate(out, whole, links, *scene.friction, loads.compliance);
  out.plate_force += on_plate + push_on_plate(out, whole, links);
  out.F0 = on_plate + axial_drag(out, whole, links);
  if (scene.friction_arm() > 0.0 && lies_in_plate(problem.topology())) add_flat_torsion(scene, out);
}

}  // namespace windlass::equilibrium
