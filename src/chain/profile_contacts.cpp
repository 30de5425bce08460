#include "profile_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

using contact::JointKind;
using Eigen::Vector3d;

Vector3d force_before(const Topology& topology, int joint, const Vector3d& before, const Vector3d& after) {
  return joint > 0 ? before : Vector3d(-contact::image(topology.symmetry).cwiseProduct(after));
}

Vector3d strand_push(const Chain& chain, const VectorXd& x, int joint) {
  const int k = chain.coupling_of(joint);
  return k < 0 ? Vector3d::Zero() : Vector3d(chain.strand_force(x, k) * chain.crossing(x, k).push_on(joint));
}

double copies(const Topology& topology, int joint) {
  return topology.half && !(topology.mid_touch && joint == 0) ? 2.0 : 1.0;
}

namespace {

/// Of the internal force at a joint, from before it to behind.
Vector3d jump(const Topology& topology, const std::vector<Piece>& pieces, int joint) {
  const Vector3d after = pieces[joint].n.col(0);
  const Vector3d before = joint > 0 ? Vector3d(pieces[joint - 1].n.rightCols<1>()) : after;
  return force_before(topology, joint, before, after) - after;
}

/// Contacts with an obstacle.
Contact obstacle_contact(const Chain& chain, const Topology& topology, const rod::Material& material,
                         const VectorXd& x, const Loads& loads, int j, const std::vector<Piece>& pieces) {
  Contact c;
  const Joint& joint = chain.joint(j);
  const obstacle::Chart here = joint.chart(chain.coordinates(x, j));
  c.edge = joint.kind() == JointKind::edge;
  c.obstacle = topology.pushed_by(j);
  c.angle = joint.surface()->turn(joint.on_surface(chain.coordinates(x, j)));
  c.r = here.r;
  c.normal = c.surface_normal = here.normal;
  const Piece& after = pieces[j];
  c.force = jump(topology, pieces, j).dot(c.normal);
  c.layer = chain.edge_layer(x, loads, j);
  const Vector3d t = rod::directors(after.q.col(0)).col(2);
  const Eigen::Vector2d along = here.tangents.transpose() * t;
  c.gap_curvature = curvature(material, after, 0).dot(c.normal) + along.dot(here.bend * along);
  // Friction's moment bends the rod, and friction along it stretches it: the curvature jumps, and the lesser gives way.
  if ((loads.arm != 0.0 || (loads.friction != 0.0 && loads.compliance != 0.0)) && j > 0) {
    const Piece& before = pieces[j - 1];
    const double ahead =
        curvature(material, before, before.s.size() - 1).dot(c.normal) + along.dot(here.bend * along);
    c.gap_curvature = std::min(c.gap_curvature, ahead);
  }
  return c;
}

/// Contacts with another strand. Of the distance D(s₁, s₂) at its least: D₁₁ = 1/D + e·r₁″, D₂₂ = 1/D − e·r₂″,
/// D₁₂ = −t₁·t₂/D.
Contact strand_contact(const Chain& chain, const Topology& topology, const rod::Material& material,
                       const VectorXd& x, int j, int coupling, const std::vector<Piece>& pieces) {
  const Chain::Crossing at = chain.crossing(x, coupling);
  const Coupling& with = at.coupling;
  Contact c;
  c.obstacle = -1;
  c.coupling = coupling;
  c.r = chain.joint(j).centreline(chain.coordinates(x, j)).r;
  c.angle = obstacle::Cylinder::angle(c.r);
  c.normal = at.push_on(j);
  c.force = chain.strand_force(x, coupling);
  if (const obstacle::Surface* surface = chain.joint(j).surface()) {
    c.obstacle = topology.obstacle(j);
    c.surface_normal = surface->normal(c.r);
    c.reaction = (jump(topology, pieces, j) - c.force * c.normal).dot(c.surface_normal);
  }
  const Vector3d first = curvature(material, pieces[with.first], 0),
                 second = with.image().cwiseProduct(curvature(material, pieces[with.second], 0));
  // The lower eigenvalue of the distance's second derivatives with the two places.
  const double by_first = 1.0 / at.distance + at.direction.dot(first),
               by_second = 1.0 / at.distance - at.direction.dot(second),
               mixed = -at.first.t.dot(at.second.t) / at.distance;
  const double own = j == with.first ? by_first : by_second, other = by_first + by_second - own;
  c.gap_second = own - mixed * mixed / other;
  c.place_ratio = -mixed / other;
  c.gap_curvature = 0.5 * (by_first + by_second) - std::hypot(0.5 * (by_first - by_second), mixed);
  return c;
}

/// Whole turns from one unrolled angle to another.
double turns(double from, double to) { return 2.0 * M_PI * std::round((from - to) / (2.0 * M_PI)); }

double last(const Piece& piece) { return piece.angle(piece.angle.size() - 1); }

/// Is it a plate beside a cylinder? It does not know how often the rod has gone round.
bool on_plate(const Contact& c, const obstacle::Set& obstacles) {
  return c.coupling < 0 && c.obstacle > 0 && obstacles[0].curvature() != 0.0;
}

/// Beyond plates, and beyond strands beside them, the rod goes on where it is, outward from the contacts of the cylinder.
void carry_turns_past_plates(std::vector<Contact>& contacts, std::vector<Piece>& pieces,
                             const obstacle::Set& obstacles) {
  const auto counts = [&](const Contact& c) { return c.coupling < 0 && !on_plate(c, obstacles); };
  const auto first = std::find_if(contacts.begin(), contacts.end(), counts);
  for (auto c = first; c != contacts.end(); ++c) {
    if (counts(*c)) continue;
    Piece &before = pieces[c->joint - 1], &after = pieces[c->joint];
    c->angle += turns(last(before), c->angle);
    after.angle.array() += turns(c->angle, after.angle(0));
  }
  for (auto c = first; c != contacts.begin();) {
    --c;
    Piece &before = pieces[c->joint - 1], &after = pieces[c->joint];
    c->angle += turns(after.angle(0), c->angle);
    before.angle.array() += turns(c->angle, last(before));
  }
}

/// Strands have no obstacle to count turns round: beyond one the rod goes on where it is.
void carry_turns(std::vector<Contact>& contacts, std::vector<Piece>& pieces) {
  for (Contact& c : contacts) {
    if (c.coupling < 0) continue;
    Piece &before = pieces[c.joint - 1], &after = pieces[c.joint];
    if (c.s > 0.0)
      after.angle.array() += turns(last(before), after.angle(0));
    else
      before.angle.array() += turns(after.angle(0), last(before));
    c.angle += turns(after.angle(0), c.angle);
  }
}

}  // namespace

void add_contacts(const Chain& chain, const Topology& topology, const VectorXd& x, const Loads& loads,
                  Profile& out) {
  for (int j = 0; j < chain.joint_count(); ++j) {
    if (!chain.is_contact(j)) continue;
    const int coupling = chain.coupling_of(j);
    Contact c = coupling < 0 ? obstacle_contact(chain, topology, out.material, x, loads, j, out.pieces)
                             : strand_contact(chain, topology, out.material, x, j, coupling, out.pieces);
    c.joint = j;
    c.s = chain.arclength(x, loads, j);
    c.z = c.r(2);
    out.contacts.push_back(c);
  }
  // Free pieces take their turn count from a neighbouring contact.
  for (const Contact& c : out.contacts)
    for (const int i : {c.joint - 1, c.joint}) {
      if (i < 0 || c.coupling >= 0 || on_plate(c, out.obstacles) || out.pieces[i].stretch == Stretch::line)
        continue;
      Piece& piece = out.pieces[i];
      const double here = i == c.joint ? piece.angle(0) : piece.angle(piece.angle.size() - 1);
      piece.angle.array() += 2.0 * M_PI * std::round((c.angle - here) / (2.0 * M_PI));
    }
  if (std::any_of(out.contacts.begin(), out.contacts.end(),
                  [&](const Contact& c) { return on_plate(c, out.obstacles); }))
    carry_turns_past_plates(out.contacts, out.pieces, out.obstacles);
  else
    carry_turns(out.contacts, out.pieces);
}

const Contact* Profile::contact_at(int joint) const {
  const auto found =
      std::find_if(contacts.begin(), contacts.end(), [&](const Contact& c) { return c.joint == joint; });
  return found == contacts.end() ? nullptr : &*found;
}

double total_contact_force(const Profile& profile, const Topology& topology) {
  double sum = 0.0;
  for (const Piece& piece : profile.pieces) sum += piece.force * (topology.half ? 2.0 : 1.0);
  const bool capstan = profile.obstacles.size() > 0 && profile.obstacles[0].slips();
  for (const Contact& c : profile.contacts)
    if (!capstan || c.obstacle <= 0)
      sum += (c.coupling < 0 ? c.force : c.reaction.value_or(0.0)) * copies(topology, c.joint);
  return sum;
}

}  // namespace windlass::chain
