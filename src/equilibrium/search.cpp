#include "windlass/equilibrium/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "harvest.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

namespace {

/// Where the diagram starts, and how far beyond the goal it goes: arms that leave beyond may come back.
struct Range {
  double from = 0.0, beyond = 0.0;
};

/// Loads at which the flat (straight) state may still be stable, next one first: higher tensions, or less compression.
std::vector<Range> ranges(const scene::Scene& scene, double goal) {
  constexpr double as_far_again = 0.5;
  if (!scene.has_cylinder) {
    if (!scene.ends.shortening) return {{0.0, goal + as_far_again * std::abs(goal)}};
    constexpr double slight = 0.01;
    std::vector<Range> out;
    for (const double from : {slight, 0.1 * slight})
      if (from < goal) out.push_back({from, goal + as_far_again * std::min(goal, 0.2)});
    return out;
  }
  std::vector<Range> out;
  // A coil whose turns press on each other is no flat coil at any tension; a stable one is found at each where strands touch.
  if (scene.strand_radius() > 0.0) out = {{1.5 * goal, as_far_again * goal}, {goal, as_far_again * goal}};
  for (double factor = 1.5; factor < 400.0; factor *= 1.7)
    out.push_back({goal * factor, goal * as_far_again});
  return out;
}

/// The state at the start of a range: flat (straight) and stable. A coil that is not found at once is left
/// for the next range: no contacts are discovered for it.
std::optional<Started> calm_state(scene::Scene scene, double load, bool spatial,
                                  const std::vector<std::string>& keys) {
  scene::set_parameter(scene, load_key(scene), load);
  const bool half = scene.obstacles_keep_half_turn() && scene.weight_keeps_half_turn();
  std::string failure;
  try {
    std::optional<Started> start = scene.has_cylinder ? followed_coil(scene, spatial, half, keys, failure)
                                                      : cold_start(scene, spatial, half, keys);
    if (start && start->problem->total_index(start->x, start->p) == 0) return start;
  } catch (const NoEquilibrium&) {
  } catch (const scene::SceneError&) {  // under a higher tension the contact arc is longer than the rod
  }
  return std::nullopt;
}

continuation::Options options_of(const Range& range) {
  continuation::Options options;
  options.target = range.beyond;
  options.direction = range.beyond < range.from ? -1 : 1;
  options.lower = std::min(range.from, range.beyond);
  options.upper = std::max(range.from, range.beyond);
  options.parameter_scale = std::clamp(0.2 * (options.upper - options.lower), 0.2, 1e3);
  options.newton_tolerance = 1e-9;
  options.max_points = 600;
  return options;
}

}  // namespace

double potential(const Solution& at, const scene::Scene& scene) {
  const ArcRecord &first = at.arcs.front(), &last = at.arcs.back();
  if (!at.has_cylinder)
    return at.energy + at.weight_energy -
           (scene.ends.shortening ? 0.0 : scene.load.thrust.value_or(0.0) * at.shortening * scene.rod.length);
  const double length = last.s(last.s.size() - 1) - first.s(0);
  if (scene.ends.guided()) {  // what holds an end on its guide does no work
    const Eigen::Vector3d right(std::cos(0.5 * at.phi), std::sin(0.5 * at.phi), 0.0),
        left(-right.x(), right.y(), 0.0);
    return at.energy + at.T * (length - right.dot(last.r.rightCols<1>()) - left.dot(first.r.col(0)));
  }
  // The force at an end is the pull there.
  return at.energy + at.T * length - last.n.rightCols<1>().dot(last.r.rightCols<1>()) +
         first.n.col(0).dot(first.r.col(0));
}

bool among(const std::vector<Vector>& fingerprints, const Vector& fingerprint) {
  return std::ranges::any_of(fingerprints, [&](const Vector& other) {
    return continuation::same_fingerprint(other, fingerprint, same_state);
  });
}

void include(Search& search, Started at) {
  Vector fingerprint = at.problem->fingerprint(at.x, at.p);
  for (const FoundState& known : search.states)
    if (continuation::same_fingerprint(known.fingerprint, fingerprint, same_state)) return;
  at.problem->error_estimate(at.x, at.p);
  const double potential =
      equilibrium::potential(record(*at.problem, at.x, at.p), scene::as_given(at.problem->scene_at(at.p)));
  // Where a motion costs nothing (a closed rod's along itself) every state of the family has this potential.
  for (const FoundState& known : search.states)
    if (std::abs(potential - known.potential) <= same_potential * std::abs(potential)) return;
  const int index = at.problem->total_index(at.x, at.p);
  FoundState state{std::move(at), index, potential, std::move(fingerprint)};
  const auto before = [](const FoundState& a, const FoundState& b) {
    return a.stable() != b.stable() ? a.stable() : a.potential < b.potential;
  };
  search.states.insert(std::upper_bound(search.states.begin(), search.states.end(), state, before),
                       std::move(state));
}

namespace {

/// On the full chain, if that is asked for; nullopt where a state of a half chain is singular there: one of a family.
std::optional<Started> on_asked_chain(Started state, bool half) {
  if (half || !state.problem->topology().half) return state;
  try {
    return unfold(*state.problem, state.x, state.p, state.newton_iterations);
  } catch (const NoEquilibrium&) {
    return std::nullopt;
  }
}

}  // namespace

Search search(const scene::Scene& asked, bool spatial, bool half, const std::vector<std::string>& keys) {
  const scene::Scene scene = scene::natural(asked);
  const std::string key = load_key(scene);
  const double goal = scene::get_parameter(scene, key);
  Search found;
  for (const Range& range : ranges(scene, goal)) {
    const std::optional<Started> start = calm_state(scene, range.from, spatial, keys);
    if (!start) continue;
    const continuation::Options options = options_of(range);
    continuation::DiagramOptions limits;
    limits.max_branches = 24;
    Harvest harvest(goal, options);
    continuation::trace_diagram(start->problem, start->x, start->p, options, limits, harvest);
    for (const Started& state : harvest.states())
      if (auto asked = on_asked_chain(state, half)) include(found, std::move(*asked));
    found.searched =
        fmt::format("{} branches, {} points, of the diagram from {} = {:.4g} to {:.4g}", harvest.branches(),
                    harvest.points(), key, scene::as_given(scene, key, range.from),
                    scene::as_given(scene, key, range.beyond));
    break;
  }
  if (found.searched.empty()) found.searched = "no load was found at which the flat state is stable";
  return found;
}

std::optional<Started> stable_state(const scene::Scene& asked, const std::vector<std::string>& keys) {
  const scene::Scene scene = scene::natural(asked);
  Search found = search(scene, true, scene.half_turn(), {load_key(scene)});
  if (!found.stable()) return std::nullopt;
  const Started& best = found.states.front().at;
  auto problem = std::make_shared<RodProblem>(scene, best.problem->spatial(), best.problem->topology(),
                                              best.problem->meshes(), keys);
  Started start{problem, best.x, problem->parameters(), best.newton_iterations};
  return problem->polish(start.x, start.p) < 0 ? std::nullopt : std::optional(start);
}

}  // namespace windlass::equilibrium
