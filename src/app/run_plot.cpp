#include <cstdio>

#include "app/commands.hpp"
#include "windlass/measurement/measurements.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/output/plot.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace {

/// Measured strengths as contact forces, F0/mu.
std::vector<std::pair<double, double>> measured_forces(const std::filesystem::path& csv,
                                                       const scene::Scene& scene) {
  if (!scene.friction || !(*scene.friction > 0.0))
    throw InputError(
        "--csv: F0 = mu R_tot needs the friction coefficient; --set cylinder.friction=0.3, or find it with "
        "`windlass fit`");
  std::vector<std::pair<double, double>> points;
  for (const auto& point : measurement::read_measurements(csv, scene.units))
    points.emplace_back(point.T, point.F0 / *scene.friction);
  return points;
}

}  // namespace

int run_plot(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  output::PlotOptions options;
  options.formats = request.formats;
  options.units = scene.units;
  options.obstacles = obstacle::obstacles_of(scene);
  options.rod_radius = scene.rod_radius;
  options.plates = scene.plates();
  options.folder = request.common.out;
  if (!request.csv.empty()) options.measured = measured_forces(request.csv, scene);
  if (!request.label.empty()) options.points = {request.label};
  const auto pictures = output::plot_run(request.run, options);
  if (!request.common.quiet)
    for (const auto& picture : pictures) std::printf("%s\n", picture.string().c_str());
  return done;
}

}  // namespace windlass::app
