#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/output/solution_json.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/stability/analysis.hpp"

namespace windlass::app {

namespace {

using equilibrium::Solution;

void add_stability(Solution& solution, const scene::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  auto problem = equilibrium::reopen(scene, solution.restart, {equilibrium::load_key(scene)});
  stability::SpectrumSolver solver;
  solution.stability =
      stability::analyse(*problem, solution.restart.state, problem->parameters(), 6, true, solver);
  solution.seconds_stability =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solution.seconds_total = solution.seconds_solve + solution.seconds_stability;
}

void print_physical(const Solution& solution, const scene::Units& units) {
  std::printf("  %-12s %.6g N (%.4g g hung)\n", "pull", solution.T * units.force,
              solution.T * units.force / 9.80665e-3);
  std::printf("  %-12s %.6g N\n", "R_tot", solution.R_tot * units.force);
  if (solution.F0) std::printf("  %-12s %.6g N\n", "F0", *solution.F0 * units.force);
  std::printf("  %-12s %.6g mm\n", "z_span", solution.z_span * units.length * 1e3);
}

void print_summary(const Solution& solution, const scene::Scene& scene) {
  std::printf("%s: %s\n", scene.name.c_str(), scene.title.c_str());
  std::printf("  %-12s %s (%s)\n", "model", solution.model.c_str(), solution.model_reason.c_str());
  if (solution.has_cylinder) {
    std::printf("  %-12s T = %.10g, phi = %.10g\n", "loads", solution.T, solution.phi);
    std::printf("  %-12s %s\n", "contact", solution.topology.c_str());
    std::printf("  %-12s %.12g (relative error about %.1e)\n", "R_tot", solution.R_tot,
                solution.error_estimate);
    if (solution.F0) std::printf("  %-12s %.12g\n", "F0", *solution.F0);
    std::printf("  %-12s %.12g\n  %-12s %.6g, z_span %.6g\n", "phi_star", solution.phi_star, "tilt",
                solution.tilt, solution.z_span);
  } else {
    std::printf("  %-12s %.12g (relative error about %.1e)\n", "end_force", solution.end_force,
                solution.error_estimate);
    std::printf("  %-12s %.12g\n  %-12s %.12g\n", "end_moment", solution.end_moment, "shortening",
                solution.shortening);
  }
  std::printf("  %-12s %.12g\n", "energy", solution.energy);
  if (solution.stability) {
    std::printf("  %-12s index %d%s, lowest eigenvalues", "stability", solution.stability->index,
                solution.stability->degenerate ? " (a contact carries no force)" : "");
    for (std::size_t k = 0; k < std::min<std::size_t>(3, solution.stability->eigenvalues.size()); ++k)
      std::printf(" %.6g", solution.stability->eigenvalues[k]);
    std::printf("\n");
  }
  std::printf("  %-12s %d Newton iterations, %d unknowns, %.2f ms\n", "work", solution.newton_iterations,
              solution.mesh.unknowns, 1e3 * solution.seconds_total);
  if (scene.units && solution.has_cylinder) print_physical(solution, *scene.units);
}

}  // namespace

int run_solve(const SolveRequest& request) {
  petsc::ensure_session();
  Solution solution = equilibrium::solve(request.scene);
  const scene::Scene scene = equilibrium::determinate(request.scene);  // the one solved
  add_stability(solution, scene);
  if (request.save) {
    output::WriterOptions options;
    options.force = request.common.force;
    options.command = "solve";
    options.version = WINDLASS_VERSION;
    output::RunWriter writer =
        output::RunWriter::create(output_folder(request.common, scene), scene, options);
    writer.add_point(output::make_row(solution, 1, 1, "S1", "start", 0.0), solution);
    writer.finish("finished", {1, solution.seconds_solve, solution.seconds_stability, solution.seconds_total},
                  {});
  }
  if (request.common.json)
    std::printf("%s\n", output::to_json(solution, scene).dump(2).c_str());
  else if (!request.common.quiet)
    print_summary(solution, scene);
  return done;
}

}  // namespace windlass::app
