#include "windlass/chain/profile.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/contact/spatial_joints.hpp"

namespace windlass::chain {

using contact::JointKind;
using contact::Side;
using Eigen::Vector3d;

namespace {

Vector3d outward(double a) { return {std::sin(a), -std::cos(a), 0.0}; }

/// Frame of a planar rod whose tangent makes the angle θ with e_x.
rod::Quaternion flat_frame(double theta) {
  static const rod::Quaternion base = contact::spatial::surface_frame(0.0, 0.0, 0.0);
  return rod::product(rod::rotation(Vector3d::UnitZ(), theta), base);
}

void resize(Piece& piece, Eigen::Index count) {
  piece.s.resize(count);
  piece.r.resize(3, count);
  piece.n.resize(3, count);
  piece.m.resize(3, count);
  piece.q.resize(4, count);
  piece.angle.resize(count);
  piece.heading.resize(count);
  piece.p.setZero(count);
  piece.inclination.resize(count);
}

/// Planar line contact: n = n_t t, m = B (1 − κ̂) e_z, p = n_t = n_a − m.
void sample_planar_line(const bvp::ArcSamples& samples, const RodKind& rod, double a0, double torque,
                        Piece& piece) {
  const double moment = rod.bending_stiffness * (1.0 - rod.natural_curvature()), tension = torque - moment;
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    const double a = a0 + samples.displacement(0, k);
    piece.angle(k) = a;
    piece.r.col(k) = outward(a);
    piece.q.col(k) = flat_frame(a);
    piece.n.col(k) = tension * Vector3d(std::cos(a), std::sin(a), 0.0);
    piece.m.col(k) = Vector3d(0.0, 0.0, moment);
    piece.p(k) = tension;
  }
}

/// Line contact in space. In the Darboux frame D₁ = N, D₂ = t×N, D₃ = t, with B = EI, m₃ the twisting moment:
///     m = (Bψ', −B cos²ψ, m₃),   n_θ = n_a − m₃ sin ψ − B cos³ψ,
///     n₁ = ψ'(m₃ − 3B sin ψ cos ψ),  n₂ = n_θ sin ψ − n_z cos ψ,  n₃ = n_θ cos ψ + n_z sin ψ,
///     Bψ'' = n₂ + m₃ cos²ψ − B sin ψ cos³ψ,
///     p = −n₁' + cos ψ n_θ,  n₁' = ψ''(m₃ − 3B sin ψ cos ψ) − 3Bψ'² cos 2ψ      (m₃' = 0).
void sample_surface(const bvp::ArcSamples& samples, const RodKind& rod, const Eigen::Vector2d& start,
                    const VectorXd& n, Piece& piece) {
  const double b = rod.bending_stiffness;
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    const double a = start(0) + samples.displacement(0, k), z = start(1) + samples.displacement(1, k);
    const double psi = samples.q(0, k), chi = samples.q(1, k), c = std::cos(psi), s = std::sin(psi);
    const double slope = samples.momentum(0, k) / b, m3 = samples.momentum(1, k);
    const double around = n(0) - m3 * s - b * c * c * c;
    const double n1 = slope * (m3 - 3.0 * b * s * c), n2 = around * s - n(1) * c, n3 = around * c + n(1) * s;
    const double bend = (n2 + m3 * c * c - b * s * c * c * c) / b;
    const Vector3d normal = outward(a), round(std::cos(a), std::sin(a), 0.0), up = Vector3d::UnitZ();
    const Vector3d t = c * round + s * up, binormal = s * round - c * up;
    piece.angle(k) = a;
    piece.r.col(k) = normal + z * up;
    piece.q.col(k) = contact::spatial::surface_frame(a, psi, chi);
    piece.n.col(k) = n1 * normal + n2 * binormal + n3 * t;
    piece.m.col(k) = b * slope * normal - b * c * c * binormal + m3 * t;
    piece.p(k) = c * around - bend * (m3 - 3.0 * b * s * c) + 3.0 * b * slope * slope * (c * c - s * s);
  }
}

/// ∫ p ds by Lobatto quadrature of cos ψ n_θ, and the jump of n₁ taken exactly.
double surface_force(const Piece& piece, const bvp::ArcSamples& samples, const RodKind& rod,
                     const VectorXd& n, double length) {
  const Eigen::Index last = piece.s.size() - 1;
  const Vector3d at_start = outward(piece.angle(0)), at_end = outward(piece.angle(last));
  double sum = at_start.dot(piece.n.col(0)) - at_end.dot(piece.n.col(last));
  const auto& table = bvp::CollocationTable::get(piece.stride);
  for (std::size_t e = 0; e + 1 < samples.nodes.size(); ++e) {
    const int first = samples.nodes[e];
    const double h = (samples.sigma(samples.nodes[e + 1]) - samples.sigma(first)) * length;
    for (int g = 0; g < table.stages; ++g) {
      double psi = 0.0;
      for (int i = 0; i <= table.stages; ++i) psi += table.value(g, i) * samples.q(0, first + i);
      const double c = std::cos(psi), m3 = samples.momentum(1, first);
      sum += h * table.weight(g) * c * (n(0) - m3 * std::sin(psi) - rod.bending_stiffness * c * c * c);
    }
  }
  return sum;
}

void sample_free(const bvp::ArcSamples& samples, const RodKind& rod, const Vector3d& start, const Vector3d& n,
                 Piece& piece) {
  Vector3d m_left = Vector3d::Zero(), r_left = start;
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    Vector3d r = start;
    r.head(samples.displacement.rows()) += samples.displacement.col(k);
    piece.r.col(k) = r;
    piece.n.col(k) = n;
    piece.q.col(k) = rod.spatial ? Eigen::Vector4d(samples.q.col(k)) : flat_frame(samples.q(0, k));
    Vector3d m(0.0, 0.0, 0.0);
    if (rod.spatial)
      m = 0.5 * rod::directors(piece.q.col(k)) * samples.momentum.col(k);
    else
      m(2) = samples.momentum(0, k);
    // Between element ends the moment follows from m' = n × d₃ more exactly than from the polynomial's slope.
    if (k % piece.stride == 0) {
      m_left = m;
      r_left = r;
    } else {
      m = m_left + n.cross(r - r_left);
    }
    piece.m.col(k) = m;
    piece.angle(k) = std::atan2(r(0), -r(1));
  }
}

void unroll(VectorXd& angle, double before) {
  for (Eigen::Index k = 0; k < angle.size(); ++k) {
    const double last = k == 0 ? before : angle(k - 1);
    angle(k) = last + std::remainder(angle(k) - last, 2.0 * M_PI);
  }
}

/// Makes angles and headings continuous along the chain. The place of a line contact is unrolled already; there the
/// heading is the place, to less than half a turn.
void unroll(std::vector<Piece>& pieces) {
  double heading =
      pieces.front().stretch == Stretch::line ? pieces.front().angle(0) : pieces.front().heading(0);
  for (Piece& piece : pieces) {
    unroll(piece.heading, heading);
    heading = piece.heading(piece.heading.size() - 1);
    if (piece.stretch != Stretch::line) unroll(piece.angle, piece.angle(0));
  }
}

}  // namespace

double gap(const Vector3d& r) { return std::hypot(r(0), r(1)) - 1.0; }

namespace {

/// Arclengths of the samples of a link.
void place_samples(const Chain& chain, const VectorXd& x, const Loads& loads, int link,
                   const Chain::Placed& placed, const bvp::ArcSamples& samples, Piece& piece) {
  double begin = chain.arclength(x, loads, link);
  const double end = chain.arclength(x, loads, link + 1);
  if (std::isinf(begin)) begin = end - placed.length;
  piece.s = VectorXd::Constant(samples.sigma.size(), begin) + placed.length * samples.sigma;
  if (!std::isinf(end)) piece.s(piece.s.size() - 1) = end;
}

/// One link as a curve, but for what `profile` fills in from its neighbours.
Piece sample_link(const Chain& chain, const RodKind& rod, const VectorXd& x, const Loads& loads, int link,
                  Stretch stretch) {
  const Chain::Placed placed = chain.place(x, loads, link);
  const Arc& arc = *chain.link(link).arc;
  const bvp::ArcSamples samples = arc.sample(placed.point());
  Piece piece;
  piece.stretch = stretch;
  piece.stride = arc.elements() > 0 ? arc.stages() : 1;
  resize(piece, samples.sigma.size());
  place_samples(chain, x, loads, link, placed, samples, piece);
  if (stretch == Stretch::line) {
    if (rod.spatial) {
      sample_surface(samples, rod, placed.left.x.head<2>(), placed.n, piece);
      piece.force = surface_force(piece, samples, rod, placed.n, placed.length);
    } else {
      sample_planar_line(samples, rod, placed.left.x(0), placed.n(0), piece);
      piece.force = piece.p(0) * placed.length;
    }
  } else {
    Vector3d n = Vector3d::Zero(), start = Vector3d::Zero();
    n.head(placed.n.size()) = placed.n;
    const JointKind before = chain.joint(link).kind();
    if ((before != JointKind::end && before != JointKind::infinity) || rod.strut) {
      start.head(placed.left.x.size()) = placed.left.x;
    } else {  // a left tail hangs on the joint at its end
      start.head(placed.right.x.size()) = placed.right.x;
      start.head(placed.n.size()) -= samples.displacement.col(samples.displacement.cols() - 1);
    }
    sample_free(samples, rod, start, n, piece);
  }
  if (!rod.spatial) {
    piece.heading = stretch == Stretch::line ? piece.angle : VectorXd(samples.q.row(0));
    piece.inclination.setZero();
    return piece;
  }
  for (Eigen::Index k = 0; k < piece.s.size(); ++k) {
    const Vector3d t = rod::directors(piece.q.col(k)).col(2);
    piece.heading(k) = std::atan2(t(1), t(0));
    piece.inclination(k) = std::asin(std::clamp(t(2), -1.0, 1.0));
  }
  return piece;
}

/// Outward force on the rod at a contact joint, from the internal forces on its two sides.
double contact_force(const Vector3d& n_before, const Vector3d& n_after, double angle) {
  return (n_before - n_after).dot(outward(angle));
}

/// n(−s) at a symmetry point: the half-turn about e_y of n(s), reversed.
Vector3d reflected(const Vector3d& n) { return {n(0), -n(1), n(2)}; }

/// How often a contact counts on the whole rod.
double copies(const Topology& topology, int joint) {
  return topology.half && !(topology.mid_touch && joint == 0) ? 2.0 : 1.0;
}

}  // namespace

Profile profile(const Chain& chain, const Topology& topology, const RodKind& rod, const VectorXd& x,
                const Loads& loads) {
  Profile out;
  const std::vector<Stretch>& kinds = topology.stretches;
  for (int i = 0; i < chain.link_count(); ++i)
    out.pieces.push_back(sample_link(chain, rod, x, loads, i, kinds[i]));
  unroll(out.pieces);
  for (int j = 0; j < chain.joint_count(); ++j) {
    if (!chain.is_contact(j)) continue;
    Contact c;
    c.joint = j;
    c.edge = chain.joint(j).kind() == JointKind::edge;
    c.s = chain.arclength(x, loads, j);
    c.angle = chain.joint(j).angle(chain.coordinates(x, j));
    c.z = chain.joint(j).height(chain.coordinates(x, j));
    const Piece& after = out.pieces[j];
    const Vector3d n_before =
        j > 0 ? Vector3d(out.pieces[j - 1].n.rightCols<1>()) : reflected(after.n.col(0));
    c.force = contact_force(n_before, after.n.col(0), c.angle);
    const Eigen::Matrix3d d = rod::directors(after.q.col(0));
    const Vector3d u = rod.natural + (d.transpose() * after.m.col(0)).cwiseQuotient(rod.stiffness);
    const Vector3d curvature = u(1) * d.col(0) - u(0) * d.col(1);
    const double around = d.col(2).dot(Vector3d(std::cos(c.angle), std::sin(c.angle), 0.0));
    c.gap_curvature = curvature.dot(outward(c.angle)) + around * around;
    out.contacts.push_back(c);
  }
  // Free pieces take their turn count from a neighbouring contact.
  for (const Contact& c : out.contacts)
    for (const int i : {c.joint - 1, c.joint}) {
      if (i < 0 || out.pieces[i].stretch == Stretch::line) continue;
      Piece& piece = out.pieces[i];
      const double here = i == c.joint ? piece.angle(0) : piece.angle(piece.angle.size() - 1);
      piece.angle.array() += 2.0 * M_PI * std::round((c.angle - here) / (2.0 * M_PI));
    }
  return out;
}

double total_contact_force(const Profile& profile, const Topology& topology) {
  double sum = 0.0;
  for (const Piece& piece : profile.pieces) sum += piece.force * (topology.half ? 2.0 : 1.0);
  for (const Contact& c : profile.contacts) sum += c.force * copies(topology, c.joint);
  return sum;
}

double total_contact_force(const Chain& chain, const Topology& topology, const RodKind& rod,
                           const VectorXd& x, const Loads& loads) {
  const std::vector<Stretch>& kinds = topology.stretches;
  double sum = 0.0;
  Vector3d n_before = Vector3d::Zero();
  for (int i = 0; i < chain.link_count(); ++i) {
    Vector3d n_first = Vector3d::Zero(), n_last;
    if (kinds[i] == Stretch::line) {
      const Piece piece = sample_link(chain, rod, x, loads, i, kinds[i]);
      sum += piece.force * (topology.half ? 2.0 : 1.0);
      n_first = piece.n.col(0), n_last = piece.n.rightCols<1>();
    } else {  // the force is constant on a free arc
      const VectorXd n = chain.force(x, loads, i);
      n_first.head(n.size()) = n;
      n_last = n_first;
    }
    if (chain.is_contact(i))
      sum += copies(topology, i) * contact_force(i > 0 ? n_before : reflected(n_first), n_first,
                                                 chain.joint(i).angle(chain.coordinates(x, i)));
    n_before = n_last;
  }
  return sum;
}

Profile::At Profile::at(double s) const {
  std::size_t i = 0;
  while (i + 1 < pieces.size() && s > pieces[i].s(pieces[i].s.size() - 1)) ++i;
  const Piece& piece = pieces[i];
  Eigen::Index first = 0;
  const Eigen::Index last = piece.s.size() - 1;
  while (first + piece.stride < last && s > piece.s(first + piece.stride)) first += piece.stride;
  const VectorXd nodes = piece.s.segment(first, piece.stride + 1);
  const double length = nodes(piece.stride) - nodes(0);
  const double x = std::clamp((s - nodes(0)) / length, 0.0, 1.0);
  const VectorXd phi = bvp::lagrange_basis((nodes.array() - nodes(0)) / length, x);
  const auto mix = [&](const auto& columns) {
    return (columns.middleCols(first, piece.stride + 1) * phi).eval();
  };
  At at;
  at.q = mix(piece.q).normalized();
  at.r = mix(piece.r);
  at.n = mix(piece.n);
  at.m = mix(piece.m);
  at.angle = piece.angle.segment(first, piece.stride + 1).dot(phi);
  at.heading = piece.heading.segment(first, piece.stride + 1).dot(phi);
  return at;
}

}  // namespace windlass::chain
