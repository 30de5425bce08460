#include "attempt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <continuation/walker.hpp>

#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;
using contact::Loads;

bool contacts_hold(RodProblem& problem, const Vector& x, const Vector& p) {
  for (const ContactEvent& event : contact_events(problem.profile(x, p), problem.topology())) {
    const double short_of = event.kind == ContactEvent::Kind::length ? least_length : 0.0;
    if (!event.passes && event.value < -1e-9 - short_of) return false;
  }
  constexpr double least_force = 1e-12;  // of R_tot, dimensionless
  return problem.target(problem.chain(), x, problem.loads(p)) > least_force;
}

ArcMesh first_mesh(Stretch stretch, const Loads& loads, double length) {
  if (stretch == Stretch::tail)
    return {chain::tail_mesh(loads.tension, length, 10, start_stages), start_stages};
  return {chain::uniform_mesh(std::max(4, static_cast<int>(std::ceil(length)))), start_stages};
}

std::optional<Started> attempt(const scene::Scene& scene, bool spatial, bool half,
                               const std::vector<std::string>& keys, const Draft& draft,
                               const chain::Profile& profile) {
  const Loads loads = loads_of(scene);
  Topology topology{draft.right, true, draft.mid_touch};
  std::vector<ArcMesh> meshes;
  for (std::size_t i = 0; i < draft.right.size(); ++i)
    meshes.push_back(first_mesh(draft.right[i], loads, draft.s[i + 1] - draft.s[i]));
  choose_tails(meshes, topology, rod_of(scene, spatial), loads, draft.s);
  auto problem = std::make_shared<RodProblem>(scene, spatial, topology, meshes, keys);
  const Vector p = problem->parameters();
  Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), profile, draft.s);
  try {
    const int iterations = problem->polish(x, p);
    if (iterations < 0 || !contacts_hold(*problem, x, p)) return std::nullopt;
    x = problem->refine(x, p);
    if (!half) return unfold(*problem, x, p, iterations);
    return Started{problem, x, p, iterations};
  } catch (const NoEquilibrium&) {
    return std::nullopt;
  }
}

std::optional<Started> reach(const Started& from, const scene::Scene& scene, double goal, bool half,
                             const std::vector<std::string>& keys, std::string& failure) {
  const auto given = [&](double p) { return from.problem->as_given(p); };
  continuation::Options options;
  options.target = goal;
  options.direction = goal < from.p(0) ? -1 : 1;
  options.detect_branch_points = false;
  options.step = 0.02;
  options.step_max = 0.2;
  options.max_points = 3000;
  // Weights are large numbers, in units of EI and a strut's length.
  if (from.problem->keys().front().starts_with("rod.weight"))
    options.parameter_scale = std::max(1.0, 0.2 * std::abs(goal - from.p(0)));
  // A branch that has turned and comes back past its start does not lead there.
  const double way = 0.1 * std::abs(goal - from.p(0));
  options.lower = std::min(goal, from.p(0)) - way;
  options.upper = std::max(goal, from.p(0)) + way;
  std::shared_ptr<continuation::Problem> last = from.problem;
  Vector x = from.x;
  int iterations = from.newton_iterations;
  if (from.p(0) != goal) {
    continuation::Walker walker(from.problem, from.x, from.p, options);
    double reached = from.p(0);
    std::string beyond;
    while (const auto point = walker.step())
      iterations += point->newton_iterations, reached = point->p(0), beyond = point->after;
    if (walker.end().kind == continuation::End::Kind::event && beyond == "no contact")
      throw NoContact(
          fmt::format("no equilibrium in contact exists at {} = {:g}: followed from {:g}, the rod lifts off "
                      "the cylinder at {:.6g}",
                      from.problem->keys().front(), given(goal), given(from.p(0)), given(reached)));
    if (walker.end().kind != continuation::End::Kind::target) {
      failure = fmt::format("followed from {} = {:g}, the branch ends at {:g}: {}",
                            from.problem->keys().front(), given(from.p(0)), given(reached),
                            beyond.empty() ? walker.end().reason : beyond + " (" + walker.end().reason + ")");
      return std::nullopt;
    }
    last = walker.problem();
    x = walker.x();
  }
  const auto& reached = dynamic_cast<const RodProblem&>(*last);
  auto problem =
      std::make_shared<RodProblem>(scene, reached.spatial(), reached.topology(), reached.meshes(), keys);
  const Vector p = problem->parameters();
  if (problem->polish(x, p) < 0)
    return failure = "Newton did not converge at the end of the way", std::nullopt;
  x = problem->refine(x, p);
  if (!half && reached.topology().half) return unfold(*problem, x, p, iterations);
  return Started{problem, x, p, iterations};
}

}  // namespace windlass::equilibrium
