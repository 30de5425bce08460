#include <cstdio>
#include <map>

#include "app/commands.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/vtk.hpp"

namespace windlass::app {

int run_export(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  std::map<std::string, std::vector<std::string>> collections;  // points of each .pvd
  if (run.points.find(request.label)) {
    collections[request.label] = {request.label};
  } else {
    for (const auto& key : run.points.keys())
      if (request.label.empty() || request.label == std::to_string(key.branch))
        collections["branch-" + std::to_string(key.branch)].push_back(
            output::point_name(key.branch, key.point, key.label));
  }
  if (collections.empty())
    throw output::OutputError(request.label.empty() ? request.run.string() + ": the run holds no points"
                                                    : "there is no stored point and no branch \"" +
                                                          request.label + "\" in " + request.run.string());
  const std::filesystem::path folder = request.common.out.empty() ? request.run / "vtk" : request.common.out;
  for (const auto& [stem, names] : collections) {
    const auto file = output::export_vtk(run, scene, names, folder, stem);
    if (!request.common.quiet) std::printf("%s  (%zu rods)\n", file.string().c_str(), names.size());
  }
  return done;
}

}  // namespace windlass::app
