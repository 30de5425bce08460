// Coils that hang from a plate on both sides: their own mirror images.
#include <algorithm>
#include <cmath>

#include "dragged_start.hpp"
#include "windlass/equilibrium/search.hpp"

namespace windlass::equilibrium {

namespace {

/// The flat coil with what is between ±end hanging below the plate.
chain::Profile hanging(chain::Profile flat, double end, double depth, double height) {
  for (chain::Piece& piece : flat.pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); ++k) {
      const double part = std::min(1.0, std::abs(piece.s(k)) / end);
      piece.r(2, k) = height - depth * std::pow(1.0 - part * part, 2);
    }
  return flat;
}

/// Contacts of such a coil from the left: the plate at ±end, the cylinder at ±edge, and where asked for in the middle.
std::vector<Pressing> contacts(double edge, double end, bool middle) {
  std::vector<Pressing> out = {{-end, -end, 1}, {-edge, -edge, 0}};
  if (middle) out.push_back({0.0, 0.0, 0});
  out.insert(out.end(), {{edge, edge, 0}, {end, end, 1}});
  return out;
}

}  // namespace

std::vector<Started> hanging_arches(const scene::Scene& scene, const std::vector<std::string>& keys) {
  scene::Scene whole = scene;
  whole.model.symmetry = scene::Symmetry::none;
  whole.ends.travel = scene::Travel::blocked;  // it needs no travel, nor a difference of the pulls
  std::vector<Started> out;
  const Started flat = flat_on_plate(whole, keys);
  const chain::Profile shape = flat.problem->profile(flat.x, flat.p);
  const double edge = shape.contacts.back().s;
  std::vector<Vector> seen;
  std::string failure;
  scene::Scene mirrored = scene;
  mirrored.model.symmetry = scene::Symmetry::mirror;
  for (const bool middle : {true, false})
    for (const double beyond : {0.5, 1.0})  // [ρ], as far as a tail of these tensions takes to level off
      for (const double depth : {0.2, 0.5, 1.0}) {
        const double end = edge + beyond;
        if (edge <= 0.0 || end >= shape.pieces.back().s.tail<1>()(0)) continue;
        const auto found = dragged_on(whole, hanging(shape, end, depth, scene.plate->height),
                                      contacts(edge, end, middle), keys, failure);
        if (!found) continue;
        const auto problem = std::make_shared<RodProblem>(mirrored, true, found->problem->topology(),
                                                          found->problem->meshes(), keys);
        auto half = fold(*problem, found->x, found->p, chain::Symmetry::mirror);
        if (!half) continue;
        const Vector fingerprint = half->problem->fingerprint(half->x, half->p);
        if (among(seen, fingerprint)) continue;
        seen.push_back(fingerprint);
        out.push_back(std::move(*half));
      }
  if (scene.mirrored()) return out;
  for (Started& arch : out) {
    Started whole = unfold(*arch.problem, arch.x, arch.p, arch.newton_iterations);
    arch = {
        std::make_shared<RodProblem>(scene, true, whole.problem->topology(), whole.problem->meshes(), keys),
        whole.x, whole.p, whole.newton_iterations};
  }
  return out;
}

}  // namespace windlass::equilibrium
