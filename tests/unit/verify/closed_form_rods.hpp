#pragma once

#include <cmath>
#include <numbers>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

/// Rods known in closed form (PHYSICS), sampled into the value type that the program stores.
namespace windlass::test {

using equilibrium::ArcKind;
using equilibrium::ArcRecord;
using equilibrium::JointKind;
using equilibrium::JointRecord;
using equilibrium::Solution;

inline ArcRecord empty_arc(ArcKind kind, const char* role, int samples) {
  ArcRecord arc;
  arc.kind = kind;
  arc.role = role;
  arc.s.resize(samples), arc.p.setZero(samples);
  arc.r.resize(3, samples), arc.q.resize(4, samples), arc.n.resize(3, samples), arc.m.resize(3, samples);
  return arc;
}

inline void set_frame(ArcRecord& arc, Eigen::Index i, const Eigen::Vector3d& d1, const Eigen::Vector3d& d3) {
  Eigen::Matrix3d frame;
  frame << d1, d3.cross(d1), d3;
  const Eigen::Quaterniond q(frame);
  arc.q.col(i) << q.w(), q.x(), q.y(), q.z();
}

/// Planar section: tangent at angle theta, bending moment kappa e_z.
inline void set_planar(ArcRecord& arc, Eigen::Index i, double s, Eigen::Vector2d r, double theta,
                       double kappa, Eigen::Vector2d n) {
  arc.s[i] = s;
  arc.r.col(i) << r, 0.0;
  set_frame(arc, i, {std::sin(theta), -std::cos(theta), 0.0}, {std::cos(theta), std::sin(theta), 0.0});
  arc.m.col(i) << 0.0, 0.0, kappa;
  arc.n.col(i) << n, 0.0;
}

/// The half-turn about e_y with s -> -s: the left half of the rod from its right half.
inline ArcRecord mirrored(const ArcRecord& right) {
  ArcRecord left = empty_arc(right.kind, right.role.c_str(), static_cast<int>(right.s.size()));
  for (Eigen::Index i = 0, j = right.s.size() - 1; j >= 0; ++i, --j) {
    const Eigen::Vector4d q = right.q.col(j);
    const Eigen::Vector3d d3 = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().col(2);
    set_planar(left, i, -right.s[j], {-right.r(0, j), right.r(1, j)}, -std::atan2(d3.y(), d3.x()),
               right.m(2, j), {right.n(0, j), -right.n(1, j)});
    left.p[i] = right.p[j];
  }
  left.s_begin = -right.s_end, left.s_end = -right.s_begin, left.force = right.force;
  return left;
}

inline scene::Scene capstan_scene(double T, double phi) {
  scene::Scene scene;
  scene.name = "capstan";
  scene.has_cylinder = true;
  scene.rod.length = HUGE_VAL;
  scene.load.tension = T;
  scene.load.angle = phi;
  scene.resolved_toml = "[rod]\nlength = \"inf\"\n[cylinder]\n[load]\ntension = " + std::to_string(T) + "\n";
  return scene;
}

/// Homoclinic tail that leaves the contact at angle `at` with the pull direction phi/2, over a length of `decades`/√T.
inline ArcRecord homoclinic_tail(double T, double phi, double at, double decay_lengths, int samples) {
  ArcRecord tail = empty_arc(ArcKind::free, "tail", samples);
  const double beta = phi / 2 - at, root = std::sqrt(T), u0 = -std::log(std::tan(beta / 4));
  const Eigen::Vector2d along(std::cos(phi / 2), std::sin(phi / 2)), across(-along.y(), along.x());
  const Eigen::Vector2d start(std::sin(at), -std::cos(at));
  for (int i = 0; i < samples; ++i) {
    const double d = decay_lengths / root * i / (samples - 1), u = u0 + root * d;
    const double sech = 1 / std::cosh(u), sech0 = 1 / std::cosh(u0);
    const double x = d - 2 / root * (std::tanh(u) - std::tanh(u0)), y = 2 / root * (sech - sech0);
    set_planar(tail, i, at + d, start + x * along + y * across, phi / 2 - 4 * std::atan(std::exp(-u)),
               2 * root * sech, T * along);
  }
  tail.s_begin = at, tail.s_end = HUGE_VAL;
  return tail;
}

/// Planar capstan with infinite tails; line contact, so T and phi as PHYSICS requires.
inline Solution planar_capstan(double T, double phi, double decay_lengths = 12, int samples = 61) {
  const double beta = std::acos(1 - 1 / (2 * T)), phi_star = phi / 2 - beta, p = T - 0.5,
               f = std::sqrt(4 * T - 1) / 2;
  ArcRecord line = empty_arc(ArcKind::line, "line", 21);
  for (int i = 0; i < 21; ++i) {
    const double a = phi_star * (i - 10) / 10.0;
    set_planar(line, i, a, {std::sin(a), -std::cos(a)}, a, 1.0, {p * std::cos(a), p * std::sin(a)});
    line.p[i] = p;
  }
  line.s_begin = -phi_star, line.s_end = phi_star, line.force = 2 * p * phi_star;
  const ArcRecord tail = homoclinic_tail(T, phi, phi_star, decay_lengths, samples);
  Solution solution;
  solution.T = T, solution.phi = phi, solution.phi_star = phi_star;
  solution.R_tot = 2 * p * phi_star + 2 * f;
  solution.model = "closed_form", solution.converged = true, solution.topology = "tail edge line edge tail";
  solution.arcs = {mirrored(tail), line, tail};
  const auto joint = [](JointKind kind, double s, double angle, double force, const Eigen::Vector3d& r) {
    JointRecord record;
    record.kind = kind, record.s = s, record.angle = angle, record.force = force, record.r = r;
    return record;
  };
  const Eigen::Index last = tail.s.size() - 1;
  solution.joints = {joint(JointKind::infinity, -HUGE_VAL, 0, 0, solution.arcs[0].r.col(0)),
                     joint(JointKind::edge, -phi_star, -phi_star, f, line.r.col(0)),
                     joint(JointKind::edge, phi_star, phi_star, f, line.r.col(20)),
                     joint(JointKind::infinity, HUGE_VAL, 0, 0, tail.r.col(last))};
  return solution;
}

/// Piece of an endless torsion-free helix of inclination psi on the cylinder. Its ends are cut anywhere, so only
/// the checks of its ends and totals can fail.
inline Solution endless_helix(double psi, double length = 6.0, int samples = 31) {
  const double c = std::cos(psi), sn = std::sin(psi);
  ArcRecord line = empty_arc(ArcKind::line, "line", samples);
  for (int i = 0; i < samples; ++i) {
    const double s = length * (i / (samples - 1.0) - 0.5), a = c * s, turn = sn * c * s;
    const Eigen::Vector3d N(std::sin(a), -std::cos(a), 0), t(c * std::cos(a), c * std::sin(a), sn),
        b = N.cross(t);
    line.s[i] = s;
    line.r.col(i) << std::sin(a), -std::cos(a), sn * s;
    // the surface frame turns about the tangent at the rate sin psi cos psi; the material frame does not
    set_frame(line, i, std::cos(turn) * N + std::sin(turn) * b, t);
    line.m.col(i) = c * c * b;
    line.n.col(i) = std::pow(c, 3) * Eigen::Vector3d(std::cos(a), std::sin(a), 0);
    line.p[i] = std::pow(c, 4);
  }
  line.s_begin = -length / 2, line.s_end = length / 2, line.force = std::pow(c, 4) * length;
  Solution solution;
  solution.T = 1.5 * std::pow(c, 4), solution.phi = 2 * std::numbers::pi, solution.converged = true;
  solution.R_tot = line.force;
  solution.energy = 0.5 * std::pow(c, 4) * length;  // bending alone: B = 1, κ = cos²ψ
  solution.topology = "line";
  solution.arcs = {line};
  solution.joints.resize(2);
  solution.joints[0].r = line.r.col(0), solution.joints[1].r = line.r.col(samples - 1);
  return solution;
}

}  // namespace windlass::test
