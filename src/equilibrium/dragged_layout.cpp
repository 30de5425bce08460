#include "dragged_layout.hpp"

#include "windlass/chain/guess.hpp"

namespace windlass::equilibrium {

using chain::Piece;

scene::Scene standing(scene::Scene scene) {
  scene.plate.reset();
  scene.second_plate.reset();
  scene.motion = {};
  return scene;
}

std::optional<Started> on_contacts(Layout layout, chain::Profile shape, double lift,
                                   const scene::Scene& scene, const std::vector<std::string>& keys,
                                   std::optional<Vector> p) {
  for (Piece& piece : shape.pieces) piece.r.row(2).array() += lift;
  choose_tails(layout.meshes, layout.topology, rod_of(scene, true), loads_of(scene), layout.s);
  const auto problem = std::make_shared<RodProblem>(scene, true, layout.topology, layout.meshes, keys);
  if (!p) p = problem->parameters();
  Vector x = chain::guess_state(problem->chain(), layout.topology, problem->rod(), shape, layout.s);
  const int used = problem->polish(x, *p);
  if (used < 0) return std::nullopt;
  return Started{problem, problem->refine(x, *p), *p, used};
}

}  // namespace windlass::equilibrium
