#include "app/stored_point.hpp"

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

equilibrium::Stability spectrum_of(const scene::Scene& scene, const equilibrium::Restart& restart, int count,
                                   bool modes, stability::SpectrumSolver& solver) {
  const auto problem = equilibrium::reopen(scene, restart, {equilibrium::load_key(scene)});
  return stability::analyse(*problem, restart.state, problem->parameters(), count, modes, solver);
}

void add_indices(std::span<equilibrium::StateSummary> states, const scene::Scene& scene) {
  stability::SpectrumSolver solver;
  for (equilibrium::StateSummary& state : states)
    if (state.index < 0) state.index = spectrum_of(scene, state.restart, 2, false, solver).index;
}

equilibrium::Stability spectrum_of_point(const scene::Scene& scene, const output::Run& run,
                                         std::size_t position, int count, stability::SpectrumSolver& solver) {
  const equilibrium::Solution stored = run.points.get(position);
  const scene::Scene at = scene_of_point(scene, run, position);
  return spectrum_of(at, stored.restart, count, true, solver);
}

}  // namespace windlass::app
