#include <cstdio>

#include "app/commands.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/verify/certificate.hpp"

namespace windlass::app {

int run_verify(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  nlohmann::ordered_json report;
  int failed = 0;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    const auto& key = run.points.keys()[k];
    const std::string name = output::point_name(key.branch, key.point, key.label);
    if (!request.label.empty() && request.label != name) continue;
    const equilibrium::Solution solution = run.points.get(k);
    scene::Scene at = scene;
    if (solution.has_cylinder) at.load.tension = solution.T, at.load.angle = solution.phi;
    if (!run.info.extra_parameter.empty() && run.rows[k].parameter)
      scene::set_parameter(at, run.info.extra_parameter, *run.rows[k].parameter);
    const verify::Certificate certificate = verify::verify(solution, at);
    report["points"].push_back({{"name", name}, {"certificate", verify::to_json(certificate)}});
    if (certificate.passed()) continue;
    ++failed;
    if (!request.common.json)
      std::printf("point %s (T = %.10g, phi = %.10g) fails:\n%s", name.c_str(), solution.T, solution.phi,
                  verify::to_text(certificate).c_str());
  }
  report["checked"] = run.points.size();
  report["failed"] = failed;
  if (request.common.json)
    std::printf("%s\n", report.dump(2).c_str());
  else if (!request.common.quiet)
    std::printf("%zu points integrated again with CVODE, %d failed\n", run.points.size(), failed);
  return failed > 0 ? certificate_failed : done;
}

}  // namespace windlass::app
