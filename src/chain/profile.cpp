#include "windlass/chain/profile.hpp"

#include <algorithm>
#include <cmath>

#include "profile_contacts.hpp"
#include "windlass/bvp/collocation_table.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/closed_form_arcs.hpp"

namespace windlass::chain {

using contact::JointKind;
using contact::Side;
using Eigen::Vector3d;

namespace {

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

/// Planar line contact round the circle: n = n_t t, m = B (λ − κ̂) e_z, n_t = n_a − m, p = λ n_t, λ = 1 without stretch.
void sample_planar_line(const bvp::ArcSamples& samples, const RodKind& rod, double a0, double torque,
                        double compliance, Piece& piece) {
  double moment = rod.bending_stiffness * (1.0 - rod.natural_curvature()), stretch = 1.0;
  if (compliance != 0.0) {
    stretch = rod::stretch_on_circle(rod.bending_stiffness, rod.natural_curvature(), torque, compliance);
    moment = rod.bending_stiffness * (stretch - rod.natural_curvature());
  }
  const double tension = torque - moment;
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    const double a = a0 + samples.displacement(0, k);
    piece.angle(k) = a;
    piece.r.col(k) = obstacle::Cylinder::outward(a);
    piece.q.col(k) = flat_frame(a);
    piece.n.col(k) = tension * obstacle::Cylinder::around(a);
    piece.m.col(k) = Vector3d(0.0, 0.0, moment);
    piece.p(k) = stretch * tension;
  }
}

/// Line contact in space, see rod/line_contact.hpp.
void sample_surface(const bvp::ArcSamples& samples, const rod::Material& material,
                    const obstacle::Surface& surface, const Eigen::Vector2d& start, const Eigen::Vector2d& n,
                    Piece& piece) {
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    const Eigen::Vector2d u = start + samples.displacement.col(k).head<2>(), q = samples.q.col(k).head<2>();
    Eigen::Vector2d here_n = samples.force.size() > 0 ? Eigen::Vector2d(samples.force.col(k)) : n;
    if (!material.weight.isZero())
      here_n -= (piece.s(k) - piece.s(0)) * (surface.chart(u).tangents.transpose() * material.weight);
    const rod::LineSection at =
        rod::line_section(surface, material, q, samples.momentum.col(k).head<2>(), here_n);
    const obstacle::Chart here = surface.chart(u);
    Vector3d force = at.n;
    if (samples.pressure.size() > 0) force(0) -= samples.lever(k) * samples.pressure(k);
    const double c = std::cos(q(0)), s = std::sin(q(0));
    Eigen::Matrix3d darboux;
    darboux << here.normal, here.tangents * Eigen::Vector2d(s, -c), here.tangents * Eigen::Vector2d(c, s);
    piece.angle(k) = surface.turn(u);
    piece.r.col(k) = here.r;
    piece.q.col(k) = contact::spatial::surface_frame(surface.base_frame(u), q(0), q(1));
    piece.n.col(k) = darboux * force;
    piece.m.col(k) = darboux * at.m;
    piece.p(k) = samples.pressure.size() > 0 ? samples.pressure(k) : at.pressure;
  }
}

/// ∫ p ds by Lobatto quadrature of the hoop part, and the jump of n·N taken exactly.
double surface_force(const Piece& piece, const bvp::ArcSamples& samples, const rod::Material& material,
                     const obstacle::Surface& surface, const Eigen::Vector2d& start, const Eigen::Vector2d& n,
                     double length) {
  if (samples.pressure.size() > 0) return samples.pressed;
  const Eigen::Index last = piece.s.size() - 1;
  const auto normal = [&](Eigen::Index k) {
    return surface.chart(start + samples.displacement.col(k).head<2>()).normal;
  };
  double sum = normal(0).dot(piece.n.col(0)) - normal(last).dot(piece.n.col(last));
  const auto& table = bvp::CollocationTable::get(piece.stride);
  for (std::size_t e = 0; e + 1 < samples.nodes.size(); ++e) {
    const int first = samples.nodes[e];
    const double h = (samples.sigma(samples.nodes[e + 1]) - samples.sigma(first)) * length;
    for (int g = 0; g < table.stages; ++g) {
      Eigen::Vector2d q = Eigen::Vector2d::Zero();
      Eigen::Vector2d along = samples.force.size() > 0 ? Eigen::Vector2d::Zero() : n;
      for (int i = 0; i <= table.stages; ++i) {
        q += table.value(g, i) * samples.q.col(first + i).head<2>();
        if (samples.force.size() > 0) along += table.value(g, i) * samples.force.col(first + i);
      }
      const Eigen::Vector2d momentum = samples.momentum.col(first).head<2>();
      sum += h * table.weight(g) * rod::line_section(surface, material, q, momentum, along).hoop;
    }
  }
  return sum;
}

void sample_free(const bvp::ArcSamples& samples, const RodKind& rod, const Vector3d& start, const Vector3d& n,
                 const Vector3d& weight, Piece& piece) {
  const bool weighs = !weight.isZero();
  Vector3d m_left = Vector3d::Zero(), r_left = start;
  for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
    Vector3d r = start;
    r.head(samples.displacement.rows()) += samples.displacement.col(k);
    piece.r.col(k) = r;
    piece.n.col(k) = weighs ? Vector3d(n - (piece.s(k) - piece.s(0)) * weight) : n;
    piece.q.col(k) = rod.spatial ? Eigen::Vector4d(samples.q.col(k)) : flat_frame(samples.q(0, k));
    Vector3d m(0.0, 0.0, 0.0);
    if (rod.spatial)
      m = 0.5 * rod::directors(piece.q.col(k)) * samples.momentum.col(k);
    else
      m(2) = samples.momentum(0, k);
    // Between element ends the moment follows from m' = n × r' more exactly than from the polynomial's slope.
    if (k % piece.stride == 0 || weighs) {
      m_left = m;
      r_left = r;
    } else {
      m = m_left + n.cross(r - r_left);
    }
    piece.m.col(k) = m;
    piece.angle(k) = obstacle::Cylinder::angle(r);
  }
}

void unroll(VectorXd& angle, double before) {
  for (Eigen::Index k = 0; k < angle.size(); ++k) {
    const double last = k == 0 ? before : angle(k - 1);
    angle(k) = last + std::remainder(angle(k) - last, 2.0 * M_PI);
  }
}

/// Makes angles and headings continuous along the chain. The place of a line contact is unrolled already, but on a plate beside a
/// cylinder; there the heading is the place, to less than half a turn.
void unroll(std::vector<Piece>& pieces, const obstacle::Set& obstacles) {
  const auto counts_turns = [&](const Piece& piece) {
    return piece.stretch == Stretch::line &&
           (obstacles[0].curvature() == 0.0 || obstacles[piece.obstacle].curvature() != 0.0);
  };
  double heading =
      pieces.front().stretch == Stretch::line ? pieces.front().angle(0) : pieces.front().heading(0);
  for (Piece& piece : pieces) {
    unroll(piece.heading, heading);
    heading = piece.heading(piece.heading.size() - 1);
    if (!counts_turns(piece)) unroll(piece.angle, piece.angle(0));
  }
}

/// Does a stretch lie in a plate, from a touch of it to what touches the cylinder, too? It carries no force along the axis.
bool held_in_plate(const RodKind& rod, const Topology& topology, int link) {
  const auto on_plate = [&](int joint) {
    return topology.seat(joint).strand == 0 && topology.seat(joint).obstacle > 0 &&
           rod.obstacles[topology.obstacle(joint)].curvature() == 0.0;
  };
  const auto on_both = [&](int joint, int beyond) {
    return topology.touches_flat(joint) || topology.lies_flat(beyond);
  };
  return topology.stretches[link] == Stretch::gap &&
         ((on_plate(link) && on_both(link + 1, link + 1)) || (on_both(link, link - 1) && on_plate(link + 1)));
}

/// Arclengths of the samples of a link.
void place_samples(const Chain& chain, const VectorXd& x, const Loads& loads, int link,
                   const Chain::Placed& placed, const bvp::ArcSamples& samples, Piece& piece) {
  double begin = chain.arclength(x, loads, link);
  const double end = chain.arclength(x, loads, link + 1);
  if (std::isinf(begin)) begin = end - placed.length;
  piece.s = VectorXd::Constant(samples.sigma.size(), begin) + placed.length * samples.sigma;
  if (!std::isinf(end)) piece.s(piece.s.size() - 1) = end;
}

/// Margin against buckling off the obstacle, of a straight line without pressure: where it carries none but rounding.
std::optional<double> buckling(const Piece& line, const bvp::ArcSamples& samples,
                               const rod::Material& material, const obstacle::Surface& surface, double length,
                               double unit) {
  constexpr double rounding = 1e-9;
  const double force = std::max(1.0, line.n.col(0).norm());
  const double bend = samples.momentum.row(0).cwiseAbs().maxCoeff();
  if (line.weld) return std::nullopt;
  if (line.p.cwiseAbs().maxCoeff() > rounding * force / unit || bend > rounding * force * unit)
    return std::nullopt;
  const double tension = line.n.col(0).dot(rod::directors(line.q.col(0)).col(2));
  return rod::buckling_margin(surface, material, samples.q(1, 0), tension, length);
}

/// ∫ of evenly spaced samples, an odd number of them.
double simpson(const VectorXd& values, double length) {
  const Eigen::Index parts = values.size() - 1;
  double sum = values(0) + values(parts);
  for (Eigen::Index k = 1; k < parts; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * values(k);
  return sum * length / (3.0 * static_cast<double>(parts));
}

double plate_height(const RodKind& rod, const Topology& topology, int link) {
  return rod.obstacles[topology.seat(link).flat].chart(Eigen::Vector2d::Zero()).r(2);
}

/// One link as a curve, but for what `profile` fills in from its neighbours.
Piece sample_link(const Chain& chain, const RodKind& rod, const VectorXd& x, const Loads& loads, int link,
                  const Topology& topology) {
  const Stretch stretch = topology.stretches[link];
  const Chain::Placed placed = chain.place(x, loads, link);
  const Arc& arc = *chain.link(link).arc;
  const bvp::ArcSamples samples = arc.sample(placed.point());
  Piece piece;
  piece.stretch = stretch;
  if (stretch == Stretch::line) piece.obstacle = topology.obstacle(link);
  piece.weld = chain.link(link).weld;
  piece.stride = arc.elements() > 0 ? arc.stages() : 1;
  resize(piece, samples.sigma.size());
  place_samples(chain, x, loads, link, placed, samples, piece);
  if (stretch == Stretch::line) {
    if (rod.spatial) {
      const obstacle::Surface& surface = rod.obstacles[piece.obstacle];
      const bool flat = topology.lies_flat(link);  // on a plate, at its height
      const Eigen::Vector2d start(placed.left.x(0),
                                  flat ? plate_height(rod, topology, link) : placed.left.x(1)),
          along(placed.n(0), flat ? 0.0 : placed.n(1));
      const double whole = topology.half && link == 0 ? 2.0 * placed.length : placed.length;
      const rod::Material material = rod.material(loads);
      sample_surface(samples, material, surface, start, along, piece);
      if (!piece.weld)
        piece.force = flat ? simpson(piece.p, placed.length)
                           : surface_force(piece, samples, material, surface, start, along, placed.length);
      piece.buckling = buckling(piece, samples, material, surface, whole, rod.unit_length);
    } else {
      sample_planar_line(samples, rod, placed.left.x(0), placed.n(0), loads.compliance, piece);
      piece.force = piece.p(0) * placed.length;
    }
  } else {
    Vector3d n = Vector3d::Zero(), start = Vector3d::Zero();
    n.head(placed.n.size()) = placed.n;
    if (held_in_plate(rod, topology, link)) n(2) = 0.0;  // but for rounding, over the cube of its length
    const JointKind before = chain.joint(link).kind();
    if ((before != JointKind::end && before != JointKind::infinity) || rod.strut) {
      start.head(placed.left.x.size()) = placed.left.x;
    } else {  // a left tail hangs on the joint at its end
      start.head(placed.right.x.size()) = placed.right.x;
      start.head(placed.n.size()) -= samples.displacement.col(samples.displacement.cols() - 1);
    }
    sample_free(samples, rod, start, n, loads.weight(), piece);
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

}  // namespace

namespace {

/// Of a rod that stretches; a function of its own, or the compiler rounds those that do not otherwise.
[[gnu::noinline]] Vector3d stretched(const rod::Material& material, const Piece& piece, Eigen::Index sample,
                                     const Vector3d& bend) {
  return bend / material.stretch(piece.n.col(sample).dot(rod::directors(piece.q.col(sample)).col(2)));
}

/// Arcs of no length between touches at one place: moment and pressure are those beside, the force falls by what each touch pushes
/// with, and what the obstacle takes is shared by them.
void fill_welds(const Chain& chain, const VectorXd& x, std::vector<Piece>& pieces) {
  const int count = static_cast<int>(pieces.size());
  for (int first = 1; first < count; ++first) {
    if (!pieces[first].weld) continue;
    int last = first;
    while (last + 1 < count && pieces[last + 1].weld) ++last;
    const Piece& before = pieces[first - 1];
    Vector3d n = before.n.rightCols<1>(), rest = n - pieces[last + 1].n.col(0);
    for (int j = first; j <= last + 1; ++j) rest -= strand_push(chain, x, j);
    for (int i = first; i <= last; ++i) {
      n -= strand_push(chain, x, i) + rest / (last - first + 2);
      pieces[i].n.colwise() = n;
      pieces[i].m.colwise() = Vector3d(before.m.rightCols<1>());
      pieces[i].p.setConstant(before.p(before.p.size() - 1));
    }
    first = last;
  }
}

}  // namespace

Vector3d curvature(const rod::Material& material, const Piece& piece, Eigen::Index sample) {
  const Eigen::Matrix3d d = rod::directors(piece.q.col(sample));
  const Vector3d u =
      material.natural + (d.transpose() * piece.m.col(sample)).cwiseQuotient(material.stiffness);
  const Vector3d bend = u(1) * d.col(0) - u(0) * d.col(1);
  return material.compliance == 0.0 ? bend : stretched(material, piece, sample, bend);
}

Profile profile(const Chain& chain, const Topology& topology, const RodKind& rod, const VectorXd& x,
                const Loads& loads) {
  Profile out;
  out.obstacles = rod.obstacles;
  out.material = rod.material(loads);
  out.unit_length = rod.unit_length;
  out.radius = loads.radius;
  out.travelled = chain.travelled(x);
  out.stands_free = stands_free(rod), out.floats = floats(rod, topology);
  out.ends_held = rod.strut || rod.guided;
  for (int i = 0; i < chain.link_count(); ++i)
    out.pieces.push_back(sample_link(chain, rod, x, loads, i, topology));
  fill_welds(chain, x, out.pieces);
  unroll(out.pieces, out.obstacles);
  add_contacts(chain, topology, x, loads, out);
  return out;
}

bool in_order(const Profile& profile) {
  return std::all_of(profile.pieces.begin(), profile.pieces.end(),
                     [](const Piece& piece) { return piece.weld || piece.length() >= 0.0; });
}

double farthest(const Profile& one, const Profile& other) {
  double most = 0.0;
  for (const Piece& piece : one.pieces)
    most = std::max(most, (piece.r.col(0) - other.at(piece.s(0)).r).norm());
  return most;
}

double total_contact_force(const Chain& chain, const Topology& topology, const RodKind& rod,
                           const VectorXd& x, const Loads& loads) {
  const std::vector<Stretch>& kinds = topology.stretches;
  double sum = 0.0;
  Vector3d n_before = Vector3d::Zero();
  for (int i = 0; i < chain.link_count(); ++i) {
    Vector3d n_first = Vector3d::Zero(), n_last;
    if (chain.link(i).weld) {  // what the obstacle takes is counted behind it
      n_before -= strand_push(chain, x, i);
      continue;
    }
    if (kinds[i] == Stretch::line) {
      const Piece piece = sample_link(chain, rod, x, loads, i, topology);
      sum += piece.force * (topology.half ? 2.0 : 1.0);
      n_first = piece.n.col(0), n_last = piece.n.rightCols<1>();
    } else {  // the force is constant on a free arc, but for its weight
      const VectorXd n = chain.force(x, loads, i);
      n_first.head(n.size()) = n;
      n_last = n_first;
      if (loads.weighs()) n_last.head(n.size()) = chain.end_force(x, loads, i);
    }
    // R_tot is what the first obstacle, the cylinder, carries; a plate's share is told apart.
    if (chain.on_obstacle(i) && (rod.strut || topology.pushed_by(i) == 0)) {
      const Vector3d normal = chain.joint(i).chart(chain.coordinates(x, i)).normal;
      sum += copies(topology, i) *
             (force_before(topology, i, n_before, n_first) - n_first - strand_push(chain, x, i)).dot(normal);
    }
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
