#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/stored_point.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/verify/certificate.hpp"

namespace windlass::app {

int run_verify(const RunRequest& request) {
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  if (run.points.size() == 0)
    throw InputError(request.run.string() + ": holds no points yet, so there is nothing to verify");
  nlohmann::ordered_json report;
  int failed = 0, too_close = 0;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    const auto& key = run.points.keys()[k];
    const std::string name = output::point_name(key.branch, key.point, key.label);
    const equilibrium::Solution solution = run.points.get(k);
    const scene::Scene here = scene_of_point(scene, run, k);
    const verify::Certificate certificate = verify::verify(solution, here, request.standard);
    report["points"].push_back({{"name", name}, {"certificate", verify::to_json(certificate)}});
    report["points"].back()["self_distance"] =
        output::finite_or_null(solution.self_distance.value_or(std::nan("")));
    too_close += solution.self_distance && *solution.self_distance < output::touching * 2.0 * here.rod_radius;
    if (certificate.passed()) continue;
    ++failed;
    if (!request.common.json)
      std::printf("point %s (T = %.10g, phi = %.10g) fails:\n%s", name.c_str(), solution.T, solution.phi,
                  verify::to_text(certificate).c_str());
  }
  report["checked"] = run.points.size();
  report["failed"] = failed;
  report["through_itself"] = too_close;
  if (request.common.json)
    std::printf("%s\n", report.dump(2).c_str());
  else if (!request.common.quiet)
    std::printf("%zu points integrated again with CVODE, %d failed\n", run.points.size(), failed);
  if (too_close > 0)
    std::fprintf(stderr,
                 "windlass: at %d points the rod passes through itself: self_distance under 2 rod.radius\n",
                 too_close);
  return failed > 0 ? certificate_failed : done;
}

}  // namespace windlass::app
