#include <cstdio>

#include "app/commands.hpp"
#include "windlass/output/plot.hpp"

namespace windlass::app {

int run_plot(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  output::PlotOptions options;
  options.formats = request.formats;
  options.units = scene.units;
  options.folder = request.common.out;
  if (!request.label.empty()) options.points = {request.label};
  const auto pictures = output::plot_run(request.run, options);
  if (!request.common.quiet)
    for (const auto& picture : pictures) std::printf("%s\n", picture.string().c_str());
  return done;
}

}  // namespace windlass::app
