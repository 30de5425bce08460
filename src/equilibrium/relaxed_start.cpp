#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "entry.hpp"
#include "strip.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/discrete_rod/thick_contacts.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/quaternion.hpp"

/// Discovery of contacts between strands: a discrete rod with smooth contact is relaxed by TAO, its contacts are read off, and
/// the state is polished on exact arcs.

namespace windlass::equilibrium {

using chain::Stretch;
using discrete_rod::SplineRod;
using discrete_rod::ThickContacts;
using Eigen::Vector3d;

namespace {

/// The relaxed rod as a curve. Without torsion (its ends are free of it): frames are carried along it, the moment is that of
/// bending; the force at a place is the pull and what presses on the rod between there and the end.
chain::Profile profile_of(const discrete_rod::ThickRod& thick, const SplineRod& rod,
                          const discrete_rod::ThickMinimum& minimum, const ThickContacts& contacts) {
  constexpr int samples = 4;  // an element
  const Eigen::Index count = samples * rod.elements() + 1;
  chain::Piece piece;
  piece.s.resize(count), piece.angle.setZero(count), piece.heading.setZero(count), piece.p.setZero(count);
  piece.inclination.setZero(count);
  piece.r.resize(3, count), piece.n.resize(3, count), piece.m.resize(3, count), piece.q.resize(4, count);
  Vector3d before = Vector3d::UnitX();
  for (Eigen::Index k = 0; k < count; ++k) {
    const int e = std::min(static_cast<int>(k / samples), rod.elements() - 1);
    const double t = static_cast<double>(k - samples * e) / samples, h = rod.length(e);
    const SplineRod::Controls controls = rod.controls(minimum.x, e);
    const Vector3d slope = controls * discrete_rod::cubic_weights(t, 1) / h, tangent = slope.normalized(),
                   bend = controls * discrete_rod::cubic_weights(t, 2) / (h * h);
    piece.s(k) = rod.knot(e) + t * h;
    piece.r.col(k) = controls * discrete_rod::cubic_weights(t, 0);
    piece.m.col(k) = tangent.cross(bend) / slope.squaredNorm();
    if (k == 0) {
      piece.q.col(k) = contact::spatial::surface_frame(0.0, std::atan2(tangent(2), tangent(0)), 0.0);
    } else {
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(before, tangent);
      piece.q.col(k) =
          rod::product(rod::Quaternion(turn.w(), turn.x(), turn.y(), turn.z()), piece.q.col(k - 1));
      const double angle = obstacle::Cylinder::angle(piece.r.col(k));
      piece.angle(k) = piece.angle(k - 1) + std::remainder(angle - piece.angle(k - 1), 2.0 * M_PI);
    }
    before = tangent;
  }
  Vector3d n = thick.tension * Vector3d(std::cos(0.5 * thick.angle), std::sin(0.5 * thick.angle), 0.0);
  auto load = contacts.loads.rbegin();
  for (Eigen::Index k = count; k-- > 0;) {
    for (; load != contacts.loads.rend() && load->s > piece.s(k); ++load) n += load->force;
    piece.n.col(k) = n;
  }
  chain::Profile out;
  out.pieces.push_back(piece);
  out.radius = thick.radius;
  return out;
}

/// The contacts as stretches and touches of a half chain.
Strip strip_of(const ThickContacts& contacts, double half_length) {
  chain::Topology alone;
  alone.stretches = {Stretch::tail};
  Strip strip(alone, {0.0, half_length});
  for (const discrete_rod::LyingStretch& lying : contacts.cylinder) {
    // A bed smears what is at a line's ends, or all of a touch.
    const double length = lying.end - lying.begin;
    const bool touch = length < 2.5 * contacts.range, at_mid = lying.begin < 0.5 * contacts.range;
    if (touch) {
      if (at_mid)
        strip.mid_touch = true;
      else
        strip.cut(strip.part_at(lying.begin), 0.5 * (lying.begin + lying.end), {});
      continue;
    }
    const double begin = lying.begin + 0.5 * contacts.range, end = lying.end - 0.5 * contacts.range;
    int i = strip.part_at(begin);
    const Stretch beyond = strip.parts[i].kind;
    if (!at_mid) strip.split(i++, begin, Stretch::gap, beyond);
    strip.split(i, end, Stretch::line, beyond, chain::Seat{});
  }
  int strand = 0;
  for (const discrete_rod::StrandTouch& touch : contacts.strands) {
    ++strand;
    strip.cut(strip.part_at(touch.s), touch.s, {0, strand});
    if (!touch.own_image)
      strip.cut(strip.part_at(touch.other), touch.other, {0, touch.mirrored ? -strand : strand});
  }
  return strip;
}

}  // namespace

std::optional<Started> relaxed_start(const scene::Scene& scene, const std::vector<Vector3d>& curve,
                                     const std::vector<std::string>& keys, std::string& failure) {
  const contact::Loads loads = loads_of(scene);
  discrete_rod::ThickRod thick{loads.tension, loads.angle, loads.half_length, loads.radius, curve};
  const double mesh = std::clamp(0.25 * loads.radius, 0.03, 0.1);
  thick.fine_length = thick.length_of_knot();
  const discrete_rod::ThickMinimum minimum = discrete_rod::minimise(thick, mesh);
  if (!minimum.converged) return failure = "the discrete rod did not come to rest", std::nullopt;
  const ThickContacts contacts = contacts_of(thick, minimum);
  const chain::Profile shape = profile_of(thick, thick.spline(minimum.h), minimum, contacts);
  const Successor next = strip_of(contacts, loads.half_length).successor();
  std::vector<chain::ArcMesh> meshes;
  const chain::Strands strands(next.topology);
  for (std::size_t i = 0; i < next.topology.stretches.size(); ++i) {
    meshes.push_back(first_mesh(next.topology.stretches[i], loads, next.s[i + 1] - next.s[i]));
    // Between touches of a line arcs are many, and short.
    if (strands.along(static_cast<int>(i))) meshes.back().nodes = chain::uniform_mesh(1);
  }
  choose_tails(meshes, next.topology, rod_of(scene, true), loads, next.s);
  auto problem = std::make_shared<RodProblem>(scene, true, next.topology, meshes, keys);
  const Vector p = problem->parameters();
  Started start{problem, chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s),
                p};
  start.newton_iterations = problem->polish(start.x, start.p);
  if (start.newton_iterations < 0)
    return failure = "Newton did not converge on the contacts " + next.topology.text(), std::nullopt;
  constexpr int most = 60;
  Entry found{start.problem, start.x, start.p};
  for (int k = 0; k < 3 && mend(found, most, false, start.newton_iterations); ++k) {
    found.x = found.problem->refine(found.x, found.p);
    const chain::Profile fine = found.problem->profile(found.x, found.p);
    const bool hold = !most_violated(contact_events(fine, found.problem->topology()), fine.unit_length);
    if (hold) return Started{found.problem, found.x, found.p, start.newton_iterations};
  }
  return failure = "no contacts were found that hold all, last " + found.problem->topology().text(),
         std::nullopt;
}

}  // namespace windlass::equilibrium
