#include "windlass/chain/guess.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/obstacle/cylinder.hpp"

namespace windlass::chain {

using Eigen::Vector3d;

namespace {

/// Momenta conserved on a line contact, from the state in its middle.
/// @param fallen  what the weight has taken of the force on the way there
void adopt_force(const obstacle::Surface* surface, const Profile::At& at, const Vector3d& fallen, double* n,
                 int forces) {
  const Vector3d begin = at.n + fallen;
  if (!surface) {
    for (int k = 0; k < forces; ++k) n[k] = begin(k);
    return;
  }
  const Eigen::Vector2d on_line =
      rod::line_forces(*surface, surface->coordinates(at.r, at.angle), at.r, begin, at.m);
  for (int k = 0; k < forces; ++k) n[k] = on_line(k);
}

/// @param surface  of a line contact, else null
/// @param turn     of a line contact, its inclination and twist, at its start on entry and at its last interior node on return [rad]
void adopt_interior(const RodKind& rod, const obstacle::Surface* surface, const Arc& arc,
                    const Profile& profile, double begin, double length, Eigen::Vector2d& turn, double* out) {
  if (arc.interior_nodes() == 0) return;
  const std::vector<double> mesh = arc.mesh();
  const VectorXd& points = bvp::CollocationTable::get(arc.stages()).lobatto;
  for (int k = 1; k <= arc.interior_nodes(); ++k) {
    const int e = k / arc.stages();
    const double sigma = mesh[e] + (mesh[e + 1] - mesh[e]) * points(k % arc.stages());
    const Profile::At at = profile.at(begin + length * sigma);
    double* q = out + (k - 1) * arc.node_ambient();
    if (surface) {
      const Eigen::Vector2d c = contact::spatial::surface_coordinates(
          at.q, surface->base_frame(surface->coordinates(at.r, at.angle)));
      q[0] = turn(0) = c(0) + 2.0 * M_PI * std::round((turn(0) - c(0)) / (2.0 * M_PI));
      q[1] = turn(1) += std::remainder(c(1) - turn(1), 2.0 * M_PI);
    } else if (rod.spatial) {
      for (int i = 0; i < 4; ++i) q[i] = at.q(i);
    } else {
      q[0] = at.heading;
    }
  }
}

/// Interior of a line contact in space. Frames give its material twist up to whole turns, which long coils make, and its
/// direction, which turns round on a plane: they are counted from the edge on the left, or the mid-point of a half chain, and
/// the joint on the right agrees.
void adopt_line(const RodKind& rod, const obstacle::Surface& surface, const Chain& chain, int link,
                const Profile& profile, double begin, double length, VectorXd& x) {
  const Arc& arc = *chain.link(link).arc;
  const auto twist_at = [&](int joint) {
    return chain.coordinates(x, joint) + chain.joint(joint).spin_coordinate();
  };
  // On a plane each joint of a line has its direction before its twist; on a cylinder a line never turns back.
  const bool turns = surface.curvature() == 0.0;
  Eigen::Vector2d turn(turns ? twist_at(link)[-1] : 0.0, *twist_at(link));
  adopt_interior(rod, &surface, arc, profile, begin, length, turn, chain.interior(x, link));
  for (int i = turns ? 0 : 1; i < 2; ++i) {
    double& right = twist_at(link + 1)[i - 1];
    right += 2.0 * M_PI * std::round((turn(i) - right) / (2.0 * M_PI));
  }
}

void set_planar(Piece& piece, Eigen::Index k, double heading, const Eigen::Vector2d& r,
                const Eigen::Vector2d& n, double m) {
  piece.heading(k) = heading;
  piece.q.col(k) = contact::spatial::surface_frame(heading, 0.0, 0.0);
  piece.r.col(k) << r, 0.0;
  piece.n.col(k) << n, 0.0;
  piece.m.col(k) << 0.0, 0.0, m;
}

Piece empty_piece(Stretch stretch, Eigen::Index count) {
  Piece piece;
  piece.stretch = stretch;
  piece.s.resize(count);
  piece.r.resize(3, count);
  piece.n.resize(3, count);
  piece.m.resize(3, count);
  piece.q.resize(4, count);
  piece.angle.setZero(count);
  piece.heading.setZero(count);
  piece.p.setZero(count);
  piece.inclination.setZero(count);
  return piece;
}

/// The force between two strands as the jump of the force in one of them, which lies on no obstacle if either does not. Touches that
/// share its place share the jump, too.
double jump_of(const Chain& chain, const VectorXd& x, int coupling, const Profile& profile,
               const std::vector<double>& s) {
  const Coupling& c = chain.couplings()[coupling];
  const bool of_second = chain.joint(c.first).surface() && !chain.joint(c.second).surface();
  const int joint = of_second ? c.second : c.first;
  int first = joint, last = joint;
  while (chain.shares_place(first)) --first;
  while (last + 1 < chain.joint_count() && chain.shares_place(last + 1)) ++last;
  const auto beside = [&](int link) { return profile.at(0.5 * (s[link] + s[link + 1])).n; };
  const Vector3d jump = beside(first - 1) - beside(last);
  Eigen::Matrix3Xd pushes(3, 0);
  Eigen::Index own = 0;
  for (int j = first; j <= last; ++j) {
    if (chain.coupling_of(j) < 0) continue;
    if (j == joint) own = pushes.cols();
    pushes.conservativeResize(Eigen::NoChange, pushes.cols() + 1);
    pushes.rightCols<1>() = chain.crossing(x, chain.coupling_of(j)).push_on(j);
  }
  return pushes.cols() == 1 ? jump.dot(pushes.col(0)) : pushes.colPivHouseholderQr().solve(jump)(own);
}

/// What of the internal force along a normal is lost at a place.
double jump_at(const Profile& profile, const Vector3d& normal, double s) {
  constexpr double beside = 1e-6;
  return normal.dot(profile.at(s - beside).n - profile.at(s + beside).n);
}

}  // namespace

VectorXd guess_state(const Chain& chain, const Topology& topology, const RodKind& rod, const Profile& profile,
                     const std::vector<double>& s) {
  const std::vector<Stretch>& kinds = topology.stretches;
  VectorXd x = VectorXd::Zero(chain.ambient_size());
  for (int j = 0; j < chain.joint_count(); ++j) {
    chain.joint(j).adopt(profile.at(s[j]), chain.coordinates(x, j));
    chain.set_arclength(x, j, s[j]);
  }
  if (chain.holds_slide())
    for (int j = 0; j < chain.joint_count(); ++j)
      if (const double share = chain.slide_share(j)) chain.slide_place(x) += share * s[j];
  chain.set_travelled(x, profile.travelled);
  for (int i = 0; i < chain.link_count(); ++i) {
    const Arc& arc = *chain.link(i).arc;
    const double begin = s[i], length = s[i + 1] - s[i];
    const obstacle::Surface* surface =
        kinds[i] == Stretch::line ? &rod.obstacles[topology.obstacle(i)] : nullptr;
    // An arc that changes the force it carries begins with its own; at the joint itself the one before it ends.
    const double where = arc.carried() > 0 ? 1e-6 : 0.5;
    if (chain.link(i).pull == 0)
      adopt_force(surface, profile.at(begin + where * length), 0.5 * length * profile.material.weight,
                  chain.force(x, i), arc.forces());
    Eigen::Vector2d no_turn = Eigen::Vector2d::Zero();
    if (surface && rod.spatial)
      adopt_line(rod, *surface, chain, i, profile, begin, length, x);
    else if (arc.interior_nodes() > 0)
      adopt_interior(rod, nullptr, arc, profile, begin, length, no_turn, chain.interior(x, i));
  }
  for (int j = 0; j < chain.joint_count(); ++j)
    if (const int force = chain.joint(j).force_coordinate(); force >= 0)
      chain.coordinates(x, j)[force] =
          jump_at(profile, chain.joint(j).chart(chain.coordinates(x, j)).normal, s[j]);
  for (std::size_t k = 0; k < chain.couplings().size(); ++k)
    chain.strand_force(x, static_cast<int>(k)) = jump_of(chain, x, static_cast<int>(k), profile, s);
  return x;
}

Profile unfolded(const Profile& half, Symmetry symmetry) {
  const Vector3d place = contact::image(symmetry), moment = contact::image_of_moment(symmetry);
  const bool turned = symmetry == Symmetry::half_turn;
  // Directors: (S d₁, −S d₂, −S d₃) under the half-turn, (S d₁, S d₂, −S d₃) in the mirror; half-turns about e_y and d₁, e_x and d₃.
  const Eigen::Vector4d i(0, 1, 0, 0), outer = turned ? Eigen::Vector4d(0, 0, 1, 0) : i,
                                       inner = turned ? i : Eigen::Vector4d(0, 0, 0, 1);
  const auto frame = [&](const Eigen::Vector4d& q) {
    return Eigen::Vector4d(rod::product(outer, rod::product(q, inner)));
  };
  const Eigen::Vector4d q0 = half.pieces.front().q.col(0);
  const double sign = frame(q0).dot(q0) < 0.0 ? -1.0 : 1.0;
  Profile out;
  out.obstacles = half.obstacles;
  out.material = half.material;
  out.radius = half.radius;
  out.unit_length = half.unit_length;
  out.travelled = half.travelled;
  for (auto piece = half.pieces.rbegin(); piece != half.pieces.rend(); ++piece) {
    Piece image = *piece;
    image.s = -piece->s.reverse();
    image.angle = -piece->angle.reverse();
    image.heading = -piece->heading.reverse();
    image.p = piece->p.reverse();
    image.inclination = -place(2) * piece->inclination.reverse();
    image.r = place.asDiagonal() * piece->r.rowwise().reverse();
    image.n = -(place.asDiagonal() * piece->n.rowwise().reverse());
    image.m = moment.asDiagonal() * piece->m.rowwise().reverse();
    const Eigen::Index count = piece->s.size();
    for (Eigen::Index k = 0; k < count; ++k) image.q.col(k) = sign * frame(piece->q.col(count - 1 - k));
    out.pieces.push_back(image);
  }
  out.pieces.insert(out.pieces.end(), half.pieces.begin(), half.pieces.end());
  return out;
}

Profile capstan_profile(double tension, double angle, double half_length, double b) {
  constexpr int line_samples = 241, tail_samples = 801;
  const double limit = 0.5 * b / tension;  // 1 − cos β
  const double beta = std::min(std::acos(std::clamp(1.0 - limit, -1.0, 1.0)), 0.5 * angle);
  const double contact = 0.5 * angle - beta;
  Profile out;
  if (contact > 0.0) {
    Piece line = empty_piece(Stretch::line, line_samples);
    const double pull = tension - 0.5 * b;
    for (int k = 0; k < line_samples; ++k) {
      const double a = contact * k / (line_samples - 1);
      line.s(k) = line.angle(k) = a;
      line.p(k) = pull;
      set_planar(line, k, a, {std::sin(a), -std::cos(a)}, pull * Eigen::Vector2d(std::cos(a), std::sin(a)),
                 b);
    }
    out.pieces.push_back(line);
  }
  Piece tail = empty_piece(Stretch::tail, tail_samples);
  const double rate = std::sqrt(tension / b), length = half_length - contact;
  const Eigen::Vector2d pull = tension * Eigen::Vector2d(std::cos(0.5 * angle), std::sin(0.5 * angle));
  Eigen::Vector2d r(std::sin(contact), -std::cos(contact));
  double before = contact, d_before = 0.0;
  for (int k = 0; k < tail_samples; ++k) {
    const double x = static_cast<double>(k) / (tail_samples - 1), d = length * x * x;
    const double psi = 4.0 * std::atan(std::tan(0.25 * beta) * std::exp(-rate * d));
    const double heading = 0.5 * angle - psi, middle = 0.5 * (heading + before);
    r += (d - d_before) * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    before = heading;
    d_before = d;
    tail.s(k) = contact + d;
    set_planar(tail, k, heading, r, pull, 2.0 * b * rate * std::sin(0.5 * psi));
    const double turn = obstacle::Cylinder::angle({r(0), r(1), 0.0}),
                 last = k == 0 ? contact : tail.angle(k - 1);
    tail.angle(k) = last + std::remainder(turn - last, 2.0 * M_PI);
  }
  out.pieces.push_back(tail);
  return out;
}

Profile strut_profile(const Loads& loads, double bow) {
  constexpr int samples = 201;
  Piece rod = empty_piece(Stretch::tail, samples);
  const double half = loads.half_length;
  Vector3d r = Vector3d::Zero();
  for (int k = 0; k < samples; ++k) {
    const double s = half * k / (samples - 1);
    const double heading = bow * std::sin(M_PI * s / half);
    rod.s(k) = s;
    if (k > 0) r += (s - rod.s(k - 1)) * Vector3d(std::cos(heading), std::sin(heading), 0.0);
    set_planar(rod, k, heading, r.head<2>(), Eigen::Vector2d::Zero(), 0.0);
    rod.q.col(k) = rod::product(rod.q.col(k), rod::rotation(Vector3d::UnitZ(), 0.5 * loads.twist * s / half));
  }
  Profile out;
  rod.r.row(1).array() -= rod.r(1, samples - 1);
  out.pieces.push_back(rod);
  return out;
}

std::vector<double> tail_mesh(double tension, double length, int elements, int stages) {
  // Equal error an element: |θ^(M+1)|^(1/(M+1)) ∝ exp(−√T d/(M+1)); the density's integral is inverted. A floor keeps
  // elements in the straight part.
  const double rate = std::sqrt(tension) / (stages + 1);
  const auto cumulative = [&](double d) { return (1.0 - std::exp(-rate * d)) / rate + 0.02 * d; };
  std::vector<double> mesh{0.0};
  for (int i = 1; i < elements; ++i) {
    const double goal = cumulative(length) * i / elements;
    double low = 0.0, high = length;
    for (int k = 0; k < 60; ++k) (cumulative(0.5 * (low + high)) < goal ? low : high) = 0.5 * (low + high);
    mesh.push_back(0.5 * (low + high) / length);
  }
  mesh.push_back(1.0);
  return mesh;
}

std::vector<double> split_mesh(const std::vector<double>& mesh, double size, double longest, double whole) {
  std::vector<double> out{mesh.front()};
  for (std::size_t k = 1; k < mesh.size(); ++k) {
    const double h = mesh[k] - mesh[k - 1];
    const int parts =
        h * size > longest && h * size < whole ? static_cast<int>(std::ceil(h * size / longest)) : 1;
    for (int i = 1; i <= parts; ++i) out.push_back(i == parts ? mesh[k] : mesh[k - 1] + h * i / parts);
  }
  return out;
}

std::vector<double> uniform_mesh(int elements) {
  std::vector<double> mesh;
  for (int i = 0; i <= elements; ++i) mesh.push_back(static_cast<double>(i) / elements);
  return mesh;
}

}  // namespace windlass::chain
