#include <fmt/format.h>

#include <cstdio>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/stored_point.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/output/report.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::app {

int run_report(const RunRequest& request) {
  petsc::ensure_session();
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  output::ReportOptions options;
  options.units = scene.units;
  options.obstacles = obstacle::obstacles_of(scene);
  options.plates = scene::natural(scene).plates();
  options.rod_radius = scene.rod_radius;
  options.file = request.common.out;
  Progress progress(request.common.quiet);
  stability::SpectrumSolver solver;
  // Runs hold the modes of special points only.
  constexpr int eigenvalues = 4;
  options.complete = [&](std::size_t position, equilibrium::Solution& solution) {
    if (solution.stability && !solution.stability->modes.empty()) return;
    progress.update(fmt::format("modes: point {} of {}", position + 1, run.points.size()));
    try {
      solution.stability = spectrum_of_point(scene, run, position, eigenvalues, solver);
    } catch (const std::domain_error&) {  // out of reach at a singular point: the page shows what is stored
    } catch (const std::runtime_error&) {
    }
  };
  const auto file = output::write_report(run, options);
  progress.finish();
  if (!request.common.quiet) std::printf("%s\n", file.string().c_str());
  return done;
}

}  // namespace windlass::app
