#include "between_plates.hpp"

#include <algorithm>
#include <cmath>

#include "attempt.hpp"

namespace windlass::equilibrium {

scene::Scene with_one_plate(const scene::Scene& scene) {
  scene::Scene out = scene;
  out.second_plate.reset();
  if (!scene.slides()) out.plate.reset();
  out.continuation.reset();
  return out;
}

std::optional<Started> between_plates(const Started& found, const scene::Scene& scene,
                                      const std::vector<std::string>& keys, std::string& failure) {
  const RodProblem& one = *found.problem;
  const auto on = [&](const scene::Scene& at, const std::vector<std::string>& in) {
    return std::make_shared<RodProblem>(at, one.spatial(), one.topology(), one.meshes(), in);
  };
  const auto with_room = on(scene, keys);
  if (contacts_hold(*with_room, found.x, with_room->parameters()))
    return Started{with_room, found.x, with_room->parameters(), found.newton_iterations};
  // From where nothing touches it.
  constexpr double clear = 0.05;  // [ρ]
  scene::Scene wide = scene;
  const chain::Profile shape = found.problem->profile(found.x, found.p);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const chain::Piece& piece : shape.pieces)
    low = std::min(low, piece.r.row(2).minCoeff()), high = std::max(high, piece.r.row(2).maxCoeff());
  const bool below = scene.second_plate->side == scene::PlateSide::below;
  const double room = scene.slides() ? 0.0 : high - low;  // a rod that floats is anywhere
  double& height = wide.second_plate->height;
  if (scene.slides())
    height = below ? low - clear : high + clear;
  else
    height = scene.plate->height + (below ? -1.0 : 1.0) * (room + clear);
  const std::vector<std::string> way{"plate.2.height"};
  const auto start = on(wide, way);
  if (!contacts_hold(*start, found.x, start->parameters()))
    return failure = "its contacts do not hold beside the second plate", std::nullopt;
  try {
    return reach({start, found.x, start->parameters(), found.newton_iterations}, scene,
                 scene.second_plate->height, false, keys, failure);
  } catch (const NoEquilibrium& none) {
    return failure = none.what(), std::nullopt;
  }
}

}  // namespace windlass::equilibrium
