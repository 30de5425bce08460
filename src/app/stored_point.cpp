#include "app/stored_point.hpp"

#include "windlass/equilibrium/opening.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/stability/analysis.hpp"

namespace windlass::app {

scene::Scene scene_of_point(scene::Scene scene, const output::Run& run, std::size_t position) {
  const output::PointStore::Key& key = run.points.keys().at(position);
  const output::BranchRow& row = run.row(output::point_name(key.branch, key.point, ""));
  if (!run.info.extra_parameter.empty() && row.parameter)
    scene::set_parameter(scene, run.info.extra_parameter, *row.parameter);
  if (scene.has_cylinder) scene.load.tension = row.T, scene.load.angle = row.phi;
  if (!scene.has_cylinder && scene.ends.shortening) scene.ends.shortening = row.shortening;
  return scene;
}

std::optional<std::string> setting_of_point(const output::Run& run, const std::string& label) {
  const std::string& key = run.info.extra_parameter;
  const auto position = run.points.find(label);
  if (key.empty() || !position) return std::nullopt;
  const output::PointStore::Key& at = run.points.keys().at(*position);
  const auto value = run.row(output::point_name(at.branch, at.point, "")).parameter;
  return value ? std::optional(key + "=" + scene::number_text(*value)) : std::nullopt;
}

namespace {

/// @param known  index of the point by the run it is of
equilibrium::Stability spectrum_at(const scene::Scene& scene, const equilibrium::Restart& restart, int count,
                                   bool modes, std::optional<int> known, stability::SpectrumSolver& solver) {
  const auto problem = equilibrium::reopen(scene, restart, {equilibrium::load_key(scene)});
  continuation::Vector x = restart.state, p = problem->parameters();
  // At an event where an arc has no length its rotations have no weight and no sign: the spectrum is that of the state
  // next to it, where it has some.
  equilibrium::Stability stability;
  const bool left = equilibrium::leave_event(*problem, x, p);
  if (!left) x = restart.state, p = problem->parameters();
  if (left || !known)
    stability = stability::analyse(*problem, x, p, count, modes, solver);
  else
    stability.index = stability.inertia_index = *known;
  stability.degenerate |= !left || x != restart.state;
  return stability;
}

}  // namespace

equilibrium::Stability spectrum_of(const scene::Scene& scene, const equilibrium::Restart& restart, int count,
                                   bool modes, stability::SpectrumSolver& solver) {
  return spectrum_at(scene, restart, count, modes, std::nullopt, solver);
}

void add_indices(std::span<equilibrium::StateSummary> states, const scene::Scene& scene) {
  stability::SpectrumSolver solver;
  for (equilibrium::StateSummary& state : states)
    if (state.index < 0) state.index = spectrum_of(scene, state.restart, 2, false, solver).index;
}

equilibrium::Equilibria judged_equilibria(const scene::Scene& asked) {
  equilibrium::Equilibria all = equilibrium::equilibria(asked);
  if (!all.answer.dragged) return all;
  const scene::Scene scene = equilibrium::determinate(asked);  // the one solved
  add_indices(all.states, scene);
  equilibrium::answer_with_stable(all, scene);
  return all;
}

equilibrium::Stability spectrum_of_point(const scene::Scene& scene, const output::Run& run,
                                         std::size_t position, int count, stability::SpectrumSolver& solver) {
  const equilibrium::Solution stored = run.points.get(position);
  const scene::Scene at = scene_of_point(scene, run, position);
  const output::PointStore::Key& key = run.points.keys().at(position);
  const std::optional<int> known = run.row(output::point_name(key.branch, key.point, "")).index;
  return spectrum_at(at, stored.restart, count, true, known, solver);
}

}  // namespace windlass::app
