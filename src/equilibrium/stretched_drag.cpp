#include "stretched_drag.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "dragged_start.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

bool carries_stretch(const Topology& topology, chain::Travel travel) {
  const std::vector<Stretch>& all = topology.stretches;
  bool lines = false, tilted = false, pressed = false;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    lines = lines || all[i] == Stretch::line;
    tilted = tilted || (all[i] == Stretch::line && !topology.lies_flat(i));
    pressed = pressed || (i > 0 && topology.lies_flat(i - 1) && topology.lies_flat(i));
  }
  if (tilted || pressed) return false;
  const std::vector<Stretch> flat_coil{Stretch::tail, Stretch::line, Stretch::tail};
  return !lines || travel != chain::Travel::free || all == flat_coil;
}

std::string stretch_not_carried() {
  return "rod.extensible: a rod that stretches is dragged at isolated touches and along lines that lie on "
         "the "
         "plate, not along lines where the friction stretches it: false leaves the stretch out";
}

namespace {

/// Followed by the compliance from the rod that does not stretch.
std::optional<Started> stretched(const Started& state, const scene::Scene& scene,
                                 const std::vector<std::string>& keys, std::string& failure) {
  const auto problem = std::make_shared<RodProblem>(inextensible(scene), true, state.problem->topology(),
                                                    state.problem->meshes(), by_compliance);
  try {
    return reach({problem, state.x, problem->parameters(), 0}, scene, scene.rod.compliance(), false, keys,
                 failure);
  } catch (const NoEquilibrium& none) {
    failure = none.what();
    return std::nullopt;
  }
}

}  // namespace

std::vector<Started> dragged_with_stretch(const scene::Scene& scene, const std::vector<std::string>& keys,
                                          std::string& searched) {
  scene::Scene rigid = inextensible(scene);
  rigid.rod.extensible = false;
  const chain::Travel travel = rod_of(scene, true).travel;
  std::vector<Started> out;
  std::string lost;
  std::size_t along_lines = 0, all = 0;
  for (const Started& state : dragged_states(rigid, {"cylinder.friction"}, searched)) {
    ++all;
    std::string failure;
    if (!carries_stretch(state.problem->topology(), travel))
      ++along_lines;
    else if (auto soft = stretched(state, scene, keys, failure))
      out.push_back(*soft);
    else
      lost += "; one state was not: " + failure;
  }
  const auto count = [](std::size_t number, const char* one, const char* more) {
    return fmt::format("{} {}", number, number == 1 ? one : more);
  };
  if (all > 0)
    searched += fmt::format("; of the {} found so {} followed to rod.axial_compliance = {:.6g}", all,
                            count(out.size(), "was", "were"), scene.rod.compliance());
  if (along_lines > 0)
    searched +=
        fmt::format("; {} along lines ({})", count(along_lines, "lies", "lie"), stretch_not_carried());
  searched += lost;
  return out;
}

}  // namespace windlass::equilibrium
