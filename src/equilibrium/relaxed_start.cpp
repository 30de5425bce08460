#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "entry.hpp"
#include "strip.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/discrete_rod/thick_contacts.hpp"
#include "windlass/equilibrium/curve_piece.hpp"

/// Discovery of contacts between strands: a discrete rod with smooth contact is relaxed by TAO, its contacts are read off, and
/// the state is polished on exact arcs.

namespace windlass::equilibrium {

using chain::Stretch;
using discrete_rod::SplineRod;
using discrete_rod::ThickContacts;
using Eigen::Vector3d;

namespace {

/// Unit of length in which a knot is relaxed [natural units]: ρ, or without a cylinder the width of its loops.
double relaxing_unit(const scene::Scene& scene, const contact::Loads& loads) {
  return scene.has_cylinder ? 1.0 : std::sqrt(scene.rod.bending_stiffness / -loads.thrust);
}

/// The rod of a scene, in that unit.
discrete_rod::ThickRod thick_rod_of(const scene::Scene& scene, const contact::Loads& loads,
                                    std::vector<Vector3d> curve) {
  const double unit = relaxing_unit(scene, loads);
  for (Vector3d& corner : curve) corner /= unit;
  discrete_rod::ThickRod thick{scene.has_cylinder ? loads.tension : 1.0,
                               scene.has_cylinder ? loads.angle : 0.0, loads.half_length / unit,
                               loads.radius / unit, std::move(curve)};
  thick.cylinder = scene.has_cylinder;
  thick.fine_length = thick.length_of_knot();
  return thick;
}

/// The relaxed rod as a curve.
chain::Profile profile_of(const discrete_rod::ThickRod& thick, const SplineRod& rod,
                          const discrete_rod::ThickMinimum& minimum, const ThickContacts& contacts,
                          double unit) {
  constexpr int samples = 4;  // an element
  const int count = samples * rod.elements() + 1;
  std::vector<CurvePlace> places;
  for (int k = 0; k < count; ++k) {
    const int e = std::min(k / samples, rod.elements() - 1);
    const double t = static_cast<double>(k - samples * e) / samples, h = rod.length(e);
    const SplineRod::Controls controls = rod.controls(minimum.x, e);
    places.push_back({rod.knot(e) + t * h, controls * discrete_rod::cubic_weights(t, 0),
                      controls * discrete_rod::cubic_weights(t, 1) / h,
                      controls * discrete_rod::cubic_weights(t, 2) / (h * h)});
  }
  const Vector3d tangent = places.front().slope.normalized();
  const Vector3d pull =
      thick.tension * Vector3d(std::cos(0.5 * thick.angle), std::sin(0.5 * thick.angle), 0.0);
  chain::Piece piece =
      without_torsion(places, contact::spatial::surface_frame(0.0, std::atan2(tangent(2), tangent(0)), 0.0),
                      pull, contacts.loads);
  piece.s *= unit, piece.r *= unit, piece.m /= unit, piece.n /= unit * unit;
  chain::Profile out;
  if (!thick.cylinder) piece.r.row(1).array() -= piece.r(1, count - 1);  // the ends lie on e_x
  out.pieces.push_back(piece);
  out.radius = unit * thick.radius;
  return out;
}

/// A line of a strand with its own image, of a few touches; more follow where its pressure asks for them. @returns the last number used
int lay_line(Strip& strip, const discrete_rod::StrandTouch& line, int first) {
  constexpr int links = 2;
  for (int k = 0; k <= links; ++k) {
    const int number = first + std::min(k, links - k);  // places k and links - k are images
    const double part = static_cast<double>(k) / links, at = line.s + part * (line.other - line.s);
    strip.cut(strip.part_at(at), at, {0, 2 * k > links ? -number : number, k < links ? part : 0.0, first});
  }
  return first + links / 2;
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
    if (touch.line) {
      strand = lay_line(strip, touch, strand);
      continue;
    }
    strip.cut(strip.part_at(touch.s), touch.s, {0, strand});
    if (!touch.own_image)
      strip.cut(strip.part_at(touch.other), touch.other, {0, touch.mirrored ? -strand : strand});
  }
  return strip;
}

/// The state on the contacts read off, polished on exact arcs, and on those that follow until all hold.
std::optional<Started> polished(const scene::Scene& scene, const discrete_rod::ThickRod& thick,
                                const chain::Profile& shape, const ThickContacts& contacts,
                                const std::vector<std::string>& keys, std::string& failure) {
  const contact::Loads loads = loads_of(scene);
  const double unit = relaxing_unit(scene, loads);
  const Successor next = strip_of(contacts, loads.half_length).successor();
  contact::Loads in_unit = loads;
  in_unit.tension = thick.tension;
  std::vector<chain::ArcMesh> meshes;
  const chain::Strands strands(next.topology);
  for (std::size_t i = 0; i < next.topology.stretches.size(); ++i) {
    meshes.push_back(first_mesh(next.topology.stretches[i], in_unit, (next.s[i + 1] - next.s[i]) / unit));
    // Between touches of a line arcs are many, and short.
    if (strands.along(static_cast<int>(i))) meshes.back() = {chain::uniform_mesh(1), stages_along_strand};
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

}  // namespace

std::optional<Started> relaxed_start(const scene::Scene& scene, const std::vector<Vector3d>& curve,
                                     const std::vector<std::string>& keys, std::string& failure) {
  const contact::Loads loads = loads_of(scene);
  const discrete_rod::ThickRod thick = thick_rod_of(scene, loads, curve);
  const double mesh = std::clamp(0.25 * thick.radius, 0.03, 0.1), unit = relaxing_unit(scene, loads);
  const discrete_rod::ThickMinimum minimum = discrete_rod::minimise(thick, mesh);
  if (minimum.open) return failure = "its pulls draw the rod straight: the curve is no knot", std::nullopt;
  if (!minimum.converged) return failure = "the discrete rod did not come to rest", std::nullopt;
  for (const bool lines : {false, true}) {
    const ThickContacts contacts = contacts_of(thick, minimum, lines);
    const chain::Profile shape = profile_of(thick, thick.spline(minimum.h), minimum, contacts, unit);
    if (const auto found = polished(scene, thick, shape, scaled(contacts, unit), keys, failure)) return found;
  }
  return std::nullopt;
}

}  // namespace windlass::equilibrium
