#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::equilibrium {

using chain::Seat;
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

/// The flat rod with its strands pressed apart by hardly anything: where they cross one passes over the other.
std::optional<Started> pressed_apart(const Started& flat, double radius) {
  const chain::Profile shape = flat.problem->profile(flat.x, flat.p);
  chain::Topology topology = flat.problem->topology();
  std::vector<chain::ArcMesh> meshes = flat.problem->meshes();
  std::vector<double> s = flat.problem->joint_places(flat.x, flat.p, shape);
  const contact::Loads loads = flat.problem->loads(flat.p);
  topology.on.resize(topology.stretches.size() + 1);
  int strand = 0;
  for (const double at : crossings(shape)) {
    std::size_t i = 0;
    while (i + 1 < topology.stretches.size() && at > s[i + 1]) ++i;
    const auto place = [](auto& list, std::size_t k) { return list.begin() + static_cast<std::ptrdiff_t>(k); };
    const Stretch kind = topology.stretches[i];
    topology.stretches[i] = Stretch::gap;
    topology.stretches.insert(place(topology.stretches, i + 1), kind);
    topology.on.insert(place(topology.on, i + 1), Seat{0, ++strand});
    meshes[i] = first_mesh(Stretch::gap, loads, at - s[i]);
    meshes.insert(place(meshes, i + 1), first_mesh(kind, loads, s[i + 1] - at));
    s.insert(place(s, i + 1), at);
  }
  if (strand == 0) return std::nullopt;
  scene::Scene scene = flat.problem->scene_at(flat.p);
  scene.self_contact = true;
  scene.rod_radius = radius;
  choose_tails(meshes, topology, flat.problem->rod(), loads, s);
  auto problem = std::make_shared<RodProblem>(scene, true, topology, meshes, std::vector<std::string>{"rod.radius"});
  chain::Profile lifted = shape;
  for (chain::Piece& piece : lifted.pieces)
    if (piece.stretch != Stretch::line) piece.r.row(2).array() += radius;
  const Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), lifted, s);
  return Started{problem, x, problem->parameters(), flat.newton_iterations};
}

}  // namespace

Started thicken(const Started& flat, const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  constexpr double thin = 1e-3;  // of the radius
  std::optional<Started> start = pressed_apart(flat, thin * scene.rod_radius);
  if (!start) return flat;
  const int used = start->problem->polish(start->x, start->p);
  if (used < 0) throw NoEquilibrium("Newton did not converge on a rod with next to no thickness from the thin one");
  start->x = start->problem->refine(start->x, start->p);
  start->newton_iterations += used;
  if (!contacts_hold(*start->problem, start->x, start->p))
    throw NoEquilibrium("pressed apart where they cross, the strands of the flat rod pull at each other");
  std::string failure;
  if (auto reached = reach(*start, scene, scene.rod_radius, half, keys, failure)) return *reached;
  throw NoEquilibrium("from the thin rod no thick one was reached: " + failure);
}

}  // namespace windlass::equilibrium
