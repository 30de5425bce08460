#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/stored_point.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/petsc/session.hpp"

namespace windlass::app {

int run_stability(const RunRequest& request) {
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  output::RunWriter writer = output::RunWriter::resume(request.run);
  stability::SpectrumSolver solver;
  nlohmann::ordered_json report;
  bool disagreement = false, found = false;
  for (std::size_t k = 0; k < run.points.size() && !interrupted_by_user(); ++k) {
    const auto& key = run.points.keys()[k];
    const std::string name = output::point_name(key.branch, key.point, key.label);
    if (!request.label.empty() && request.label != name) continue;
    found = true;
    const equilibrium::Stability stability = spectrum_of_point(scene, run, k, request.eigenvalues, solver);
    writer.set_stability(name, stability);
    // At a singular point the sign of the vanishing eigenvalue is rounding or what bracketing left, and so is the count.
    double nearest = 1.0;
    for (double value : stability.eigenvalues) nearest = std::min(nearest, std::abs(value));
    disagreement |= nearest > 1e-9 && !stability.degenerate && stability.index != stability.inertia_index;
    nlohmann::ordered_json entry = {{"name", name},
                                    {"index", stability.index},
                                    {"inertia_index", stability.inertia_index},
                                    {"eigenvalues", stability.eigenvalues},
                                    {"degenerate", stability.degenerate}};
    if (!request.common.json && !request.common.quiet) {
      std::printf("%-8s index %d (inertia %d) ", name.c_str(), stability.index, stability.inertia_index);
      for (double value : stability.eigenvalues) std::printf(" %.8g", value);
      if (!stability.modes.empty())
        std::printf("  lowest: %s plane, %s", (stability.modes[0].plane == "in" ? "in" : "out of"),
                    stability.modes[0].parity.c_str());
      std::printf(stability.degenerate ? "  degenerate\n" : "\n");
    }
    report["points"].push_back(entry);
  }
  if (!request.label.empty() && !found && !interrupted_by_user())
    run.points.get(request.label);  // throws, listing what there is
  writer.commit();
  if (request.common.json) std::printf("%s\n", report.dump(2).c_str());
  if (disagreement)
    std::fprintf(stderr, "windlass: at some points SLEPc and the inertia disagree on the index\n");
  return interrupted_by_user() ? interrupted : disagreement ? not_finished : done;
}

}  // namespace windlass::app
