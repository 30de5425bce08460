#include "dragged_further.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "dragged_start.hpp"
#include "layer_mesh.hpp"
#include "windlass/chain/guess.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::equilibrium {

namespace {

/// Lines whose edges have a force of their own: however little of what is asked for makes layers of it that the mesh does not know,
/// so that Newton's method goes at once as far as it gets, to the whole of it or half or a quarter, ..
std::optional<Started> leapt(const Started& state, const Further& further, double goal) {
  constexpr int halvings = 8;
  const chain::Profile shape = state.problem->profile(state.x, state.p);
  const std::vector<double> s = state.problem->joint_places(state.x, state.p, shape);
  for (int k = 0; k <= halvings; ++k) {
    scene::Scene there = further.from;
    scene::set_parameter(there, further.keys.front(), std::ldexp(goal, -k));
    auto problem = std::make_shared<RodProblem>(there, true, state.problem->topology(),
                                                state.problem->meshes(), further.keys);
    const Vector p = problem->parameters();
    const auto guess = [&] {
      return chain::guess_state(problem->chain(), problem->topology(), problem->rod(), shape, s);
    };
    problem = std::make_shared<RodProblem>(
        there, true, state.problem->topology(),
        with_layers(problem->chain(), problem->meshes(), guess(), problem->loads(p)), further.keys);
    Started out{problem, guess(), p, 0};
    if (problem->polish(out.x, out.p) >= 0 && contacts_hold(*problem, out.x, out.p)) return out;
  }
  return std::nullopt;
}

std::optional<Started> followed(const Started& state, const scene::Scene& scene, const Further& further,
                                const std::vector<std::string>& keys, std::string& failure) {
  const auto problem = std::make_shared<RodProblem>(further.from, true, state.problem->topology(),
                                                    state.problem->meshes(), further.keys);
  try {
    if (problem->chain().ambient_size() == state.x.size())
      return reach({problem, state.x, problem->parameters(), 0}, scene, further.to, false, keys, failure);
    if (const auto start = leapt(state, further, further.to))
      return reach(*start, scene, further.to, false, keys, failure);
    failure = "Newton's method does not converge on " + state.problem->topology().text();
  } catch (const NoEquilibrium& none) {
    failure = none.what();
  }
  return std::nullopt;
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
