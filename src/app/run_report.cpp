#include <cstdio>

#include "app/commands.hpp"
#include "windlass/output/report.hpp"

namespace windlass::app {

int run_report(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  output::ReportOptions options;
  options.units = scene.units;
  options.file = request.common.out;
  const auto file = output::write_report(request.run, options);
  if (!request.common.quiet) std::printf("%s\n", file.string().c_str());
  return done;
}

}  // namespace windlass::app
