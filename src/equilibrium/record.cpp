#include "windlass/equilibrium/record.hpp"

#include <algorithm>
#include <cmath>

#include "dense_samples.hpp"
#include "record_drag.hpp"
#include "windlass/bvp/collocation_table.hpp"
#include "windlass/chain/self_distance.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/quaternion.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Stretch;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

/// Element ends only: there collocation is superconvergent, and the certificate integrates from sample to sample.
ArcRecord arc_record(const Piece& piece) {
  const Stretch stretch = piece.stretch;
  ArcRecord arc;
  arc.kind = stretch == Stretch::line ? ArcKind::line : ArcKind::free;
  arc.role = stretch == Stretch::line ? "line" : stretch == Stretch::gap ? "gap" : "tail";
  const Eigen::Index count = (piece.s.size() - 1) / piece.stride + 1;
  arc.s.resize(count);
  arc.r.resize(3, count);
  arc.q.resize(4, count);
  arc.n.resize(3, count);
  arc.m.resize(3, count);
  arc.p.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index i = k * piece.stride;
    arc.s(k) = piece.s(i);
    arc.r.col(k) = piece.r.col(i);
    arc.q.col(k) = piece.q.col(i);
    arc.n.col(k) = piece.n.col(i);
    arc.m.col(k) = piece.m.col(i);
    arc.p(k) = piece.p(i);
  }
  arc.s_begin = arc.s(0);
  arc.s_end = arc.s(count - 1);
  arc.force = piece.force;
  arc.obstacle = stretch == Stretch::line ? piece.obstacle : -1;
  return arc;
}

void append(ArcRecord& arc, const ArcRecord& next) {
  const Eigen::Index a = arc.s.size(), b = next.s.size() - 1;  // the shared sample once
  const auto join = [&](auto& left, const auto& right) {
    auto both = left;
    both.conservativeResize(Eigen::NoChange, a + b);
    both.rightCols(b) = right.rightCols(b);
    left = both;
  };
  Eigen::VectorXd s(a + b), p(a + b);
  s << arc.s, next.s.tail(b);
  p << arc.p, next.p.tail(b);
  arc.s = s;
  arc.p = p;
  join(arc.r, next.r);
  join(arc.q, next.q);
  join(arc.n, next.n);
  join(arc.m, next.m);
  arc.s_end = next.s_end;
  arc.force += next.force;
}

JointRecord end_record(const ArcRecord& arc, bool at_end, bool infinite) {
  JointRecord joint;
  joint.kind = infinite ? JointKind::infinity : JointKind::end;
  const Eigen::Index k = at_end ? arc.s.size() - 1 : 0;
  joint.s = arc.s(k);
  joint.r = arc.r.col(k);
  joint.angle = obstacle::Cylinder::angle(joint.r);
  joint.z = joint.r(2);
  return joint;
}

/// @param side  −1: the contact's image
JointRecord contact_record(const chain::Contact& c, int side, chain::Symmetry symmetry) {
  const Vector3d image = side > 0 ? Vector3d(Vector3d::Ones()) : contact::image(symmetry);
  JointRecord joint;
  joint.kind = c.edge ? JointKind::edge : c.obstacle < 0 ? JointKind::strand : JointKind::touch;
  joint.s = side * c.s;
  joint.angle = side * c.angle;
  joint.z = image(2) * c.z;
  joint.force = c.coupling < 0 ? c.force : c.reaction.value_or(0.0);
  if (c.coupling >= 0) joint.strand_force = c.force;
  joint.obstacle = c.obstacle;
  joint.r = image.cwiseProduct(c.r);
  joint.normal = image.cwiseProduct(c.surface_normal);
  return joint;
}

/// A contact on its way into a solution.
struct Placed {
  JointRecord record;
  int joint = 0, side = 1;           ///< of the chain; −1: its image
  Vector3d push = Vector3d::Zero();  ///< of another strand
};

Placed placed_contact(const chain::Contact& c, int side, chain::Symmetry symmetry) {
  Placed out{contact_record(c, side, symmetry), c.joint, side};
  if (c.coupling >= 0) {
    out.push = c.force * c.normal;
    if (side < 0) out.push = contact::image(symmetry).cwiseProduct(out.push);
  }
  return out;
}

/// Names each strand's joint to the one that it touches.
void name_partners(const std::vector<chain::Coupling>& couplings, std::vector<Placed>& contacts) {
  for (Placed& contact : contacts)
    for (const chain::Coupling& c : couplings) {
      if (contact.joint != c.first && contact.joint != c.second) continue;
      const int joint = contact.joint == c.first ? c.second : c.first;
      const int side = c.mirrored ? -contact.side : contact.side;
      const auto found = std::find_if(contacts.begin(), contacts.end(), [&](const Placed& other) {
        return other.joint == joint && other.side == side;
      });
      if (found != contacts.end()) contact.record.partner = 1 + static_cast<int>(found - contacts.begin());
      contact.record.along_strand = c.along;
    }
}

/// Where two touches are just passing each other the arc between them has no length, and its state is that of its neighbours:
/// what of the strands' forces the obstacle takes is shared by the two.
void fill_between_touches(std::vector<ArcRecord>& arcs, std::size_t k, Placed& before, Placed& after) {
  const ArcRecord &left = arcs[k - 1], &right = arcs[k + 1];
  ArcRecord& arc = arcs[k];
  const Vector3d rest = left.n.rightCols<1>() - right.n.col(0) - before.push - after.push;
  const JointRecord& here = before.record;
  const Vector3d share = here.obstacle >= 0 ? Vector3d(0.5 * rest) : Vector3d::Zero();  // with its friction
  before.record.force = after.record.force = share.dot(here.normal);
  arc.r.colwise() = Vector3d(left.r.rightCols<1>());
  arc.q.colwise() = Vector4d(left.q.rightCols<1>());
  arc.m.colwise() = Vector3d(left.m.rightCols<1>());
  arc.n.colwise() = Vector3d(left.n.rightCols<1>() - before.push - share);
  arc.p.setConstant(left.p(left.p.size() - 1));
  arc.force = 0.0;
}

/// Where a touch of strands is just passing the edge of a line, the arc between the two has no length and no state of its own:
/// they are one joint.
void merge_vanishing(std::vector<ArcRecord>& arcs, std::vector<Placed>& contacts) {
  constexpr double none = 1e-12;
  for (std::size_t k = 1; k < contacts.size();) {
    Placed &before = contacts[k - 1], &after = contacts[k];
    const int strands = (before.record.strand_force != 0.0) + (after.record.strand_force != 0.0);
    const bool vanishes = std::abs(arcs[k].s_end - arcs[k].s_begin) < none;
    if (vanishes && strands == 2) fill_between_touches(arcs, k, before, after);
    if (!vanishes || strands != 1) {
      ++k;
      continue;
    }
    const bool edge_first = before.record.kind == JointKind::edge;
    Placed touch = edge_first ? after : before;  // its partner knows it by this joint
    const double strand_force = touch.record.strand_force;
    touch.record = edge_first ? before.record : after.record;
    const Vector3d jump = arcs[k - 1].n.rightCols<1>() - arcs[k + 1].n.col(0);
    touch.record.force = (jump - touch.push).dot(touch.record.normal);
    touch.record.strand_force = strand_force;
    contacts[k - 1] = touch;
    contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(k));
    arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// The force of a plate on an end that touches it: what the rod carries there besides its pull, which is normal to the axis.
void push_end(JointRecord& end, const ArcRecord& arc, bool right, int plate, const obstacle::Set& obstacles) {
  if (plate <= 0) return;
  const Vector3d n = right ? Vector3d(arc.n.rightCols<1>()) : Vector3d(-arc.n.col(0));
  end.obstacle = plate;
  end.normal = obstacles[plate].normal(end.r);
  end.force = n.dot(end.normal);
}

/// Arcs and joints of the whole rod from −L/2 to L/2.
void assemble(const chain::Profile& shape, const chain::Profile& whole, const Topology& topology,
              bool infinite, Solution& out) {
  std::vector<ArcRecord> arcs;
  for (const Piece& piece : whole.pieces) arcs.push_back(arc_record(piece));
  std::vector<Placed> contacts;
  if (topology.half)
    for (std::size_t j = shape.contacts.size(); j-- > 0;)
      if (!(topology.mid_touch && j == 0))
        contacts.push_back(placed_contact(shape.contacts[j], -1, topology.symmetry));
  for (const chain::Contact& c : shape.contacts) contacts.push_back(placed_contact(c, 1, topology.symmetry));
  if (topology.half && !topology.mid_touch) {  // the mid-point is no joint: its stretch spans both halves
    const std::size_t middle = topology.stretches.size();
    append(arcs[middle - 1], arcs[middle]);
    arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(middle));
  }
  merge_vanishing(arcs, contacts);
  name_partners(topology.couplings(), contacts);
  out.joints.push_back(end_record(arcs.front(), false, infinite));
  for (const Placed& contact : contacts) {
    out.joints.push_back(contact.record);
    out.self_force += 0.5 * contact.record.strand_force;
  }
  out.joints.push_back(end_record(arcs.back(), true, infinite));
  const Topology full = chain::unfolded(topology);
  push_end(out.joints.front(), arcs.front(), false, full.end_touches(0), shape.obstacles);
  push_end(out.joints.back(), arcs.back(), true, full.end_touches(static_cast<int>(full.stretches.size())),
           shape.obstacles);
  out.arcs = std::move(arcs);
}

void measure_shape(const chain::Profile& whole, Solution& out) {
  double first = 1e300, last = -1e300;
  out.tilt = std::asin(std::clamp(rod::directors(whole.at(0.0).q)(2, 2), -1.0, 1.0));
  out.z_span = extent_in_z(whole);
  for (const JointRecord& joint : out.joints) {
    if (joint.kind != JointKind::touch && joint.kind != JointKind::edge) continue;
    if (out.has_cylinder && joint.obstacle > 0) continue;  // on a plate
    first = std::min(first, joint.angle);
    last = std::max(last, joint.angle);
  }
  out.phi_star = last > first ? 0.5 * (last - first) : 0.0;
}

}  // namespace

Vector3d strand_direction(const Solution& solution, const JointRecord& joint) {
  return (joint.r - solution.joints.at(static_cast<std::size_t>(joint.partner)).r).normalized();
}

namespace {

/// −∫ w·r ds: the centre of each element's weight by its Lagrange points.
double energy_of_weight(const chain::Profile& whole, const Vector3d& weight) {
  double sum = 0.0;
  for (const Piece& piece : whole.pieces) {
    if (piece.stride < bvp::min_stages) continue;  // none of these weighs
    const auto& table = bvp::CollocationTable::get(static_cast<int>(piece.stride));
    const Eigen::VectorXd share = table.value.transpose() * table.weight;
    for (Eigen::Index first = 0; first + piece.stride < piece.s.size(); first += piece.stride)
      sum -= (piece.s(first + piece.stride) - piece.s(first)) *
             weight.dot(piece.r.middleCols(first, piece.stride + 1) * share);
  }
  return sum;
}

double largest_stretch(const Solution& state, double compliance) {
  double largest = 0.0;
  for (const ArcRecord& arc : state.arcs)
    for (Eigen::Index k = 0; k < arc.s.size(); ++k)
      largest = std::max(largest, std::abs(arc.n.col(k).dot(rod::directors(arc.q.col(k)).col(2))));
  return std::abs(compliance) * largest;
}

}  // namespace

void measure_invariants(Solution& out, const chain::RodKind& kind, const contact::Loads& loads) {
  double h0 = 0.0, torque0 = 0.0, strands = 0.0;  // strands: torque that others have taken up to here
  Vector3d balance = Vector3d::Zero();
  bool first = true;
  for (std::size_t i = 0; i < out.arcs.size(); ++i) {
    const ArcRecord& arc = out.arcs[i];
    first = first || out.joints[i].holding != 0.0;  // across it they change
    if (const JointRecord& joint = out.joints[i]; joint.partner >= 0)
      strands += joint.strand_force * joint.r.cross(strand_direction(out, joint))(2);
    for (Eigen::Index k = 0; k < arc.s.size(); ++k) {
      const Eigen::Matrix3d d = rod::directors(arc.q.col(k));
      const Vector3d m = d.transpose() * arc.m.col(k);
      const double tension = arc.n.col(k).dot(d.col(2));
      double h = 0.5 * m.dot(m.cwiseQuotient(kind.stiffness)) + m.dot(kind.natural) + tension;
      if (kind.stretches())
        h += 0.5 * loads.compliance * tension * tension + loads.weight().dot(arc.r.col(k));
      const double torque = (arc.m.col(k) + arc.r.col(k).cross(arc.n.col(k)))(2) + strands;
      if (first) h0 = h, torque0 = torque, first = false;
      out.invariants.hamiltonian_drift = std::max(out.invariants.hamiltonian_drift, std::abs(h - h0));
      if (!kind.strut)
        out.invariants.axial_torque_drift =
            std::max(out.invariants.axial_torque_drift, std::abs(torque - torque0));
    }
    // Contact pressure carried by a line: the change of its internal force.
    if (arc.kind == ArcKind::line) balance += arc.n.col(arc.n.cols() - 1) - arc.n.col(0);
  }
  for (const JointRecord& joint : out.joints) {
    if (joint.kind != JointKind::end)
      balance -= joint.force * joint.normal;  // its force is the rod's own there
    balance -= joint.holding * joint.holding_direction();
  }
  if (kind.strut) return;
  balance -= out.arcs.back().n.rightCols<1>() - out.arcs.front().n.col(0);
  out.invariants.force_residual = balance.norm();
}

Solution record(RodProblem& problem, const Vector& x, const Vector& p) {
  const contact::Loads loads = problem.loads(p);
  const chain::Profile shape = problem.profile(x, p);
  const scene::Scene scene = problem.scene_at(p);
  const Topology& topology = problem.topology();
  Solution out;
  out.T = loads.tension;
  out.phi = loads.angle;
  out.has_cylinder = scene.has_cylinder;
  out.model = !problem.spatial() ? "planar" : topology.half ? "kirchhoff_half" : "kirchhoff_full";
  out.converged = true;
  out.topology = scene.has_cylinder || topology.contact() ? topology.text() : "strut";
  const chain::Profile image = topology.half ? chain::unfolded(shape, topology.symmetry) : chain::Profile();
  const chain::Profile& whole = topology.half ? image : shape;
  assemble(shape, whole, topology, problem.rod().infinite, out);
  if (const auto self = chain::self_distance(whole, scene.rod_radius)) {
    out.self_distance = self->distance;
    out.self_s = {self->s1, self->s2};
  }
  measure_shape(whole, out);
  const double copies = topology.half ? 2.0 : 1.0;
  for (int i = 0; i < problem.chain().link_count(); ++i) {
    const bvp::Arc& arc = *problem.chain().link(i).arc;
    out.energy += copies * arc.energy(problem.chain().place(x, loads, i).point());
    out.mesh.elements += arc.elements();
    if (arc.elements() > 0) out.mesh.stages = arc.stages();
  }
  out.mesh.unknowns = static_cast<int>(problem.chain().size());
  // Holding forces act on the rod like contact forces, against λ's sign in the balance.
  for (int j = 0; j < problem.chain().joint_count(); ++j)
    if (const double share = problem.chain().slide_share(j); share > 0.0 && problem.chain().holds_slide())
      out.joints[j].holding = -share * problem.chain().holding_force(x);
  for (const ArcRecord& arc : out.arcs) out.R_tot += arc.force;
  for (const JointRecord& joint : out.joints)
    if (scene.has_cylinder && joint.obstacle > 0)
      out.plate_force += std::abs(joint.normal.z()) * joint.force;  // its outer edge pushes aside, too
    else
      out.R_tot += joint.force;
  if (scene.has_cylinder) {
    if (scene.friction) out.F0 = *scene.friction * out.R_tot;
    record_drag(problem, x, loads, scene, out);
  } else {
    const ArcRecord& last = out.arcs.back();
    out.end_force = 0.0 - last.n(0, last.n.cols() - 1);  // never −0
    out.end_moment = last.m(0, last.m.cols() - 1);
    out.shortening = 1.0 - (last.r(0, last.r.cols() - 1) - out.arcs.front().r(0, 0)) / scene.rod.length;
    out.phi_star = 0.0;
  }
  measure_invariants(out, problem.rod(), loads);
  if (loads.compliance != 0.0) out.stretch = largest_stretch(out, loads.compliance);
  if (loads.weighs()) out.weight_energy = energy_of_weight(whole, loads.weight());
  if (out.dragged) measure_drag(out, *scene.friction, loads.compliance);
  out.error_estimate = problem.last_error();
  out.restart = restart_of(problem, x);
  multiply(out, scene.solved_in);
  return out;
}

}  // namespace windlass::equilibrium
