#include "dragged_further.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "dragged_start.hpp"

namespace windlass::equilibrium {

namespace {

std::optional<Started> followed(const Started& state, const scene::Scene& scene, const Further& further,
                                const std::vector<std::string>& keys, std::string& failure) {
  const auto problem = std::make_shared<RodProblem>(further.from, true, state.problem->topology(),
                                                    state.problem->meshes(), further.keys);
  try {
    return reach({problem, state.x, problem->parameters(), 0}, scene, further.to, false, keys, failure);
  } catch (const NoEquilibrium& none) {
    failure = none.what();
    return std::nullopt;
  }
}

}  // namespace

std::vector<Started> dragged_further(const scene::Scene& scene, const Further& further,
                                     const std::vector<std::string>& keys, std::string& searched) {
  std::vector<Started> out;
  std::string lost;
  std::size_t along_lines = 0, all = 0;
  for (const Started& state : dragged_states(further.simpler, {"cylinder.friction"}, searched)) {
    ++all;
    std::string failure;
    if (!further.carries(state.problem->topology()))
      ++along_lines;
    else if (auto found = followed(state, scene, further, keys, failure))
      out.push_back(*found);
    else
      lost += "; one state was not: " + failure;
  }
  const auto count = [](std::size_t number, const char* one, const char* more) {
    return fmt::format("{} {}", number, number == 1 ? one : more);
  };
  if (all > 0)
    searched += fmt::format("; of the {} found so {} followed to {}", all, count(out.size(), "was", "were"),
                            further.what);
  if (along_lines > 0)
    searched += fmt::format("; {} along lines ({})", count(along_lines, "lies", "lie"), further.not_carried);
  searched += lost;
  return out;
}

}  // namespace windlass::equilibrium
