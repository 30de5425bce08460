#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "entry.hpp"
#include "strip.hpp"
#include "windlass/equilibrium/opening.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

namespace {

/// Where the rod of a flat half chain passes through its own image, on free arcs.
std::vector<double> crossings(const chain::Profile& shape) {
  std::vector<double> out;
  for (const chain::Piece& piece : shape.pieces) {
    if (piece.stretch == Stretch::line) continue;
    for (Eigen::Index k = 1; k < piece.s.size(); ++k) {
      const double before = piece.r(0, k - 1), after = piece.r(0, k);
      if (before == 0.0 || before * after > 0.0) continue;  // at s = 0 it always is its own image
      out.push_back(piece.s(k - 1) + (piece.s(k) - piece.s(k - 1)) * before / (before - after));
    }
  }
  return out;
}

/// A touch between strands to be: a place on the half rod, and a mark of what it touches (chain::Seat).
struct Crossing {
  double s;
  int strand;
};

/// Where the turns of a coil lie on each other each tail touches the strand that it lies over, a turn further in: it has left
/// the cylinder by then, for turns of one inclination keep their distance. At `radius` next to nothing it has hardly.
std::vector<Crossing> overlaps(const chain::Profile& shape, double radius) {
  std::vector<Crossing> out;
  for (const chain::Piece& piece : shape.pieces) {
    if (piece.stretch == Stretch::line) continue;
    for (Eigen::Index k = 0; k < piece.s.size(); ++k) {
      if (piece.r.col(k).head<2>().norm() - 1.0 < radius) continue;
      const double under = piece.angle(k) - 2.0 * M_PI;  // on the circle arclength is angle
      if (std::abs(under) > shape.pieces.front().s.tail<1>()(0)) break;
      out.push_back({std::abs(under), under > 0.0 ? 1 : -1});
      out.push_back({piece.s(k), 1});
      return out;
    }
  }
  return out;
}

std::vector<Crossing> touches_of(const chain::Profile& shape, double radius) {
  const chain::Piece& middle = shape.pieces.front();
  constexpr double overlapping = M_PI;  // of half the coil
  if (middle.stretch == Stretch::line && middle.s.tail<1>()(0) > overlapping) return overlaps(shape, radius);
  std::vector<Crossing> out;
  for (const double s : crossings(shape)) out.push_back({s, static_cast<int>(out.size()) + 1});
  return out;
}

/// The flat rod with its strands pressed apart by hardly anything: where they cross one passes over the other, where turns
/// lie on each other they lie side by side.
std::optional<Started> pressed_apart(const Started& flat, double radius) {
  const chain::Profile shape = flat.problem->profile(flat.x, flat.p);
  const contact::Loads loads = flat.problem->loads(flat.p);
  Strip strip(flat.problem->topology(), flat.problem->joint_places(flat.x, flat.p, shape));
  const std::vector<Crossing> touches = touches_of(shape, radius);
  if (touches.empty()) return std::nullopt;
  for (const Crossing& touch : touches) strip.cut(strip.part_at(touch.s), touch.s, {0, touch.strand});
  const Successor next = strip.successor();
  const chain::Topology& topology = next.topology;
  const std::vector<double>& s = next.s;
  const std::vector<int>& source = next.source;
  std::vector<chain::ArcMesh> meshes;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const bool whole = std::count(source.begin(), source.end(), source[i]) == 1;
    meshes.push_back(whole ? flat.problem->meshes()[source[i]]
                           : first_mesh(topology.stretches[i], loads, s[i + 1] - s[i]));
  }
  scene::Scene scene = flat.problem->scene_at(flat.p);
  scene.self_contact = true;
  scene.rod_radius = radius;
  choose_tails(meshes, topology, flat.problem->rod(), loads, s);
  auto problem =
      std::make_shared<RodProblem>(scene, true, topology, meshes, std::vector<std::string>{"rod.radius"});
  chain::Profile lifted = shape;
  for (chain::Piece& piece : lifted.pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      piece.r(2, k) += radius * std::min(piece.angle(k), 0.5 * loads.angle) / M_PI;
  const Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), lifted, s);
  return Started{problem, x, problem->parameters(), flat.newton_iterations};
}

/// The flat rod pressed apart and in balance. @param mended  with the contacts that follow where they do not hold at once
std::optional<Started> settled_apart(const Started& flat, double radius, bool mended) {
  std::optional<Started> trial = pressed_apart(flat, radius);
  if (!trial) return std::nullopt;
  const int used = trial->problem->polish(trial->x, trial->p);
  if (used < 0) return std::nullopt;
  trial->newton_iterations += used;
  if (contacts_hold(*trial->problem, trial->x, trial->p)) return trial;
  constexpr int most = 6;
  Entry entry{trial->problem, trial->x, trial->p};
  if (!mended || !tried([&] { return mend(entry, most, false, trial->newton_iterations); }))
    return std::nullopt;
  trial->problem = entry.problem, trial->x = entry.x;
  return contacts_hold(*trial->problem, trial->x, trial->p) ? trial : std::nullopt;
}

/// A flat rod that nowhere crosses itself, as one that may.
Started as_thick(const Started& flat, const scene::Scene& scene, bool half,
                 const std::vector<std::string>& keys) {
  auto problem =
      std::make_shared<RodProblem>(scene, true, flat.problem->topology(), flat.problem->meshes(), keys);
  Started thick{problem, flat.x, problem->parameters(), flat.newton_iterations};
  return half ? thick : unfold(*problem, thick.x, thick.p, thick.newton_iterations);
}

}  // namespace

std::optional<Started> thicken(const Started& flat, const scene::Scene& scene, bool half,
                               const std::vector<std::string>& keys, std::string& failure) {
  if (!pressed_apart(flat, std::min(0.01, scene.rod_radius))) return as_thick(flat, scene, half, keys);
  std::optional<Started> start;
  // As thick as Newton's method reaches at once: under high tension turns part by so little that they must be thinner. Turns between
  // clamps are twisted, and press on each other however thin they are.
  for (const bool mended : {false, true})
    for (double radius = std::min(0.01, scene.rod_radius); !start && radius > 1e-5; radius *= 0.3)
      start = settled_apart(flat, radius, mended);
  if (!start) {
    failure = "pressed apart where they cross, the strands of the flat rod would pull at each other";
    return std::nullopt;
  }
  start->x = start->problem->refine(start->x, start->p);
  auto reached = reach(*start, scene, scene.rod_radius, half, keys, failure);
  if (!reached) failure = "from the thin rod no thick one was reached: " + failure;
  return reached;
}

}  // namespace windlass::equilibrium
