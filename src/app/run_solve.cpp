#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/stored_point.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/output/solution_json.hpp"
#include "windlass/petsc/session.hpp"

namespace windlass::app {

namespace {

using equilibrium::Solution;

void add_stability(Solution& solution, const scene::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  stability::SpectrumSolver solver;
  solution.stability = spectrum_of(scene, solution.restart, 6, true, solver);
  solution.seconds_stability =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solution.seconds_total = solution.seconds_solve + solution.seconds_stability;
}

constexpr double degrees = 180.0 / M_PI;

/// A quantity without dimension and, for a material scene, with its unit beside it.
void print_quantity(const char* name, double value, const std::string& physical,
                    const std::string& note = "") {
  fmt::print("  {:<12} {:<20.12g} {}{}\n", name, value, physical, note);
}

/// Empty for a dimensionless scene.
struct Physical {
  const std::optional<scene::Units>& units;

  std::string force(double value) const {
    return units ? fmt::format("{:.6g} N  ", value * units->force) : "";
  }
  std::string pull(double value) const {
    return units ? fmt::format("{:.6g} N, {:.5g} g hung  ", value * units->force,
                               value * units->force / 9.80665e-3)
                 : "";
  }
  std::string length(double value) const {
    return units ? fmt::format("{:.6g} mm  ", value * units->length * 1e3) : "";
  }
  std::string moment(double value) const {
    return units ? fmt::format("{:.6g} N mm  ", value * units->moment * 1e3) : "";
  }
  static std::string beside(const std::string& quantity) { return quantity.empty() ? "" : " = " + quantity; }
  std::string pressure(double value) const {
    return units ? fmt::format("{:.6g} N/mm  ", value * units->pressure * 1e-3) : "";
  }
};

void print_contacts(const Solution& solution, const Physical& physical) {
  for (std::size_t k = 0; k < solution.joints.size(); ++k) {
    const auto& joint = solution.joints[k];
    if (joint.kind == equilibrium::JointKind::touch || joint.kind == equilibrium::JointKind::edge)
      print_quantity(joint.kind == equilibrium::JointKind::touch ? "  touch" : "  edge", joint.force,
                     physical.force(joint.force),
                     fmt::format("at s = {:.6g}{}", joint.s, physical.beside(physical.length(joint.s))));
    if (joint.partner >= 0) {
      const double other = solution.joints[static_cast<std::size_t>(joint.partner)].s;
      print_quantity("  cross", joint.strand_force, physical.force(joint.strand_force),
                     fmt::format("at s = {:.6g}{}, with the strand at s = {:.6g}{}", joint.s,
                                 physical.beside(physical.length(joint.s)), other,
                                 physical.beside(physical.length(other))));
    }
    if (k >= solution.arcs.size() || solution.arcs[k].kind != equilibrium::ArcKind::line) continue;
    const auto& line = solution.arcs[k];
    print_quantity("  line", line.force, physical.force(line.force),
                   fmt::format("pressure up to {:.6g}{}", line.p.maxCoeff(),
                               physical.beside(physical.pressure(line.p.maxCoeff()))));
  }
}

void print_capstan(const Solution& solution, const scene::Scene& scene, const Physical& physical,
                   const std::string& error) {
  print_quantity("T", solution.T, physical.pull(solution.T));
  print_quantity("phi", solution.phi, fmt::format("{:.6g}°", solution.phi * degrees));
  print_quantity("R_tot", solution.R_tot, physical.force(solution.R_tot), error);
  if (solution.F0) print_quantity("F0", *solution.F0, physical.force(*solution.F0));
  if (solution.dragged) {
    print_quantity("plate", solution.plate_force, physical.force(solution.plate_force));
    if (scene.ends.travel == scene::Travel::free)
      print_quantity("travel", solution.travel_rate, "of the cylinder's speed, along itself");
    else
      print_quantity("travel", solution.pull_difference, physical.force(solution.pull_difference),
                     "blocked: the pulls are T +- this");
  }
  print_quantity("phi_star", solution.phi_star, fmt::format("{:.6g}°", solution.phi_star * degrees));
  print_quantity("tilt", solution.tilt, fmt::format("{:.6g}°", solution.tilt * degrees));
  print_quantity("z_span", solution.z_span, physical.length(solution.z_span));
  fmt::print("  {:<12} {}\n", "contact", solution.topology);
  print_contacts(solution, physical);
}

void print_strut(const Solution& solution, const Physical& physical, const std::string& error) {
  print_quantity("end_force", solution.end_force, physical.force(solution.end_force), error);
  print_quantity("end_moment", solution.end_moment, physical.moment(solution.end_moment));
  print_quantity("shortening", solution.shortening, "");
}

nlohmann::ordered_json to_json(const equilibrium::Equilibria& found, const scene::Scene& scene) {
  nlohmann::ordered_json json = output::to_json(found.answer, scene);
  for (const equilibrium::StateSummary& state : found.states) {
    nlohmann::ordered_json one;
    if (found.answer.has_cylinder) {
      one["R_tot"] = state.R_tot;
      if (state.F0) one["F0"] = *state.F0;
    } else {
      one["end_force"] = state.end_force;
      one["end_moment"] = state.end_moment;
    }
    one["energy"] = state.energy;
    one["potential"] = state.potential;
    one["index"] = state.index;
    one["topology"] = state.topology;
    json["states"].push_back(std::move(one));
  }
  return json;
}

/// The equilibria besides the one shown above.
void print_others(const equilibrium::Equilibria& found) {
  const Solution& solution = found.answer;
  for (std::size_t k = 1; k < found.states.size(); ++k) {
    const equilibrium::StateSummary& other = found.states[k];
    if (solution.dragged) {
      fmt::print("  {:<12} R_tot = {:.8g}, F0 = {:.8g}, index {}, {}\n", k == 1 ? "others" : "", other.R_tot,
                 other.F0.value_or(NAN), other.index, other.topology);
      continue;
    }
    fmt::print("  {:<12} {} = {:.8g}, energy {:.8g}, potential {:+.3g} from it, index {}, {}\n",
               k == 1 ? "others" : "", solution.has_cylinder ? "R_tot" : "end_force",
               solution.has_cylinder ? other.R_tot : other.end_force, other.energy,
               other.potential - found.states[0].potential, other.index, other.topology);
  }
}

void print_summary(const equilibrium::Equilibria& found, const scene::Scene& scene) {
  const Solution& solution = found.answer;
  const Physical physical{scene.units};
  const std::string error = fmt::format("(relative error about {:.1e})", solution.error_estimate);
  fmt::print("{}: {}\n", scene.name, scene.title);
  fmt::print("  {:<12} {} ({})\n", "model", solution.model, solution.model_reason);
  if (scene.units)
    fmt::print("  {:<12} length {:.6g} mm, force EI/ρ² = {:.6g} N\n", "units", scene.units->length * 1e3,
               scene.units->force);
  if (solution.has_cylinder)
    print_capstan(solution, scene, physical, error);
  else
    print_strut(solution, physical, error);
  print_quantity("energy", solution.energy, physical.moment(solution.energy));
  if (solution.stretch > 0.0) fmt::print("  {:<12} {:.8g} at most\n", "stretch", solution.stretch);
  if (solution.self_distance)
    print_quantity("self_distance", *solution.self_distance, physical.length(*solution.self_distance),
                   fmt::format("between s = {:.6g} and {:.6g}", solution.self_s[0], solution.self_s[1]));
  if (solution.stability) {
    fmt::print("  {:<12} index {}{}, lowest eigenvalues", "stability", solution.stability->index,
               solution.stability->degenerate
                   ? " (degenerate: a contact carries no force or an eigenvalue is zero to rounding)"
                   : "");
    for (std::size_t k = 0; k < std::min<std::size_t>(3, solution.stability->eigenvalues.size()); ++k)
      fmt::print(" {:.6g}", solution.stability->eigenvalues[k]);
    fmt::print("\n");
    constexpr double noticeable = 1e-6;  // of T
    if (solution.stability->sliding < -noticeable * solution.T)
      fmt::print("  {:<12} the rod slides off along itself: d²Π/dδ² = {:.6g} (held against it above)\n",
                 "sliding", solution.stability->sliding);
  }
  print_others(found);
  fmt::print("  {:<12} {} Newton iterations, {} unknowns, {:.2f} ms\n", "work", solution.newton_iterations,
             solution.mesh.unknowns, 1e3 * solution.seconds_total);
}

/// On stderr, whatever else is printed: an answer that is not what was asked for.
void warn(const Solution& solution, const scene::Scene& scene) {
  if (solution.error_estimate > scene.model.tolerance)
    fmt::print(stderr, "windlass: model.tolerance = {:g} was not met: the error estimate is {:.1e}\n",
               scene.model.tolerance, solution.error_estimate);
  if (solution.self_distance && *solution.self_distance < output::touching * 2.0 * scene.rod_radius)
    fmt::print(
        stderr,
        "windlass: the rod passes through itself: self_distance = {:.6g} (s = {:.6g} and {:.6g}), under "
        "2 rod.radius = {:.6g}\n",
        *solution.self_distance, solution.self_s[0], solution.self_s[1], 2.0 * scene.rod_radius);
}

}  // namespace

int run_solve(const SolveRequest& request) {
  petsc::ensure_session();
  const scene::Scene scene = equilibrium::determinate(request.scene);  // the one solved
  const equilibrium::Equilibria found = [&] {
    const Heartbeat heartbeat(scene.name + ": searching the equilibrium", request.common.quiet);
    equilibrium::Equilibria all = judged_equilibria(request.scene);
    add_stability(all.answer, scene);
    return all;
  }();
  const Solution& solution = found.answer;
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
  warn(solution, scene);
  if (request.common.json)
    std::printf("%s\n", to_json(found, scene).dump(2).c_str());
  else if (!request.common.quiet)
    print_summary(found, scene);
  return done;
}

}  // namespace windlass::app
