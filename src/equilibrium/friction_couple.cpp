#include "friction_couple.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "dragged_start.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

bool carries_couple(const Topology& topology) {
  for (int i = 0; i < static_cast<int>(topology.stretches.size()); ++i)
    if (topology.stretches[i] == Stretch::line || topology.touches_flat(i)) return false;
  return topology.couplings().empty();
}

std::string couple_not_carried() {
  return "cylinder.friction_couple: is built for isolated touches, not for rods that lie along a line on the "
         "cylinder or on the plate; false leaves the moment of the friction out";
}

std::string rim_not_thickened() {
  return "plate.outer_radius: a rod that touches the plate's outer edge is not followed in rod.radius";
}

namespace {

/// Followed by the radius from nothing, where friction has no moment.
std::optional<Started> thickened(const Started& state, const scene::Scene& scene,
                                 const std::vector<std::string>& keys, std::string& failure) {
  scene::Scene slender = scene;
  slender.rod_radius = 0.0;
  const auto problem =
      std::make_shared<RodProblem>(slender, true, state.problem->topology(), state.problem->meshes(),
                                   std::vector<std::string>{"rod.radius"});
  try {
    return reach({problem, state.x, problem->parameters(), 0}, scene, scene.rod_radius, false, keys, failure);
  } catch (const NoEquilibrium& none) {
    failure = none.what();
    return std::nullopt;
  }
}

}  // namespace

std::vector<Started> dragged_with_couple(const scene::Scene& scene, const std::vector<std::string>& keys,
                                         std::string& searched) {
  scene::Scene without = scene;
  without.motion.friction_couple = false;
  std::vector<Started> out;
  std::string lost;
  std::size_t lines = 0, all = 0;
  for (const Started& state : dragged_states(without, {"cylinder.friction"}, searched)) {
    ++all;
    std::string failure;
    if (!carries_couple(state.problem->topology()))
      ++lines;
    else if (auto thick = thickened(state, scene, keys, failure))
      out.push_back(*thick);
    else
      lost += "; one state was not: " + failure;
  }
  const auto count = [](std::size_t number, const char* one, const char* more) {
    return fmt::format("{} {}", number, number == 1 ? one : more);
  };
  if (all > 0)
    searched +=
        fmt::format("; of the {} found so {} followed to the moment of the friction at rod.radius = {:.6g}",
                    all, count(out.size(), "was", "were"), scene.rod_radius);
  if (lines > 0)
    searched += fmt::format("; {} along lines ({})", count(lines, "lies", "lie"), couple_not_carried());
  searched += lost;
  return out;
}

}  // namespace windlass::equilibrium
