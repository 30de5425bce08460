#include <algorithm>
#include <cmath>
#include <continuation/locus.hpp>
#include <continuation/walker.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/stored_point.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

using continuation::LocusPoint;
using continuation::PointType;
using equilibrium::RodProblem;

namespace {

PointType type_of(const std::string& type) {
  return type == "fold"           ? PointType::fold
         : type == "branch_point" ? PointType::branch_point
                                  : PointType::event;
}

/// The special point located again, with everything the locus needs, by walking over it from either side.
std::optional<continuation::Point> relocate(const scene::Scene& scene, const equilibrium::Solution& stored,
                                            const std::vector<std::string>& keys, PointType type) {
  for (const double side : {0.02, -0.02, 0.005, -0.005}) {
    auto problem = equilibrium::reopen(scene, stored.restart, keys);
    const continuation::Vector at = problem->parameters();
    continuation::Vector p = at, x = stored.restart.state;
    p(0) += side * std::max(1.0, std::abs(at(0)));
    if (problem->polish(x, p) < 0) continue;
    continuation::Options options;
    options.direction = side > 0.0 ? -1 : 1;
    options.target = at(0) - side * std::max(1.0, std::abs(at(0)));
    options.newton_tolerance = 1e-9;
    continuation::Walker walker(problem, x, p, options);
    while (const auto point = walker.step())
      if (point->type == type && std::abs(point->p(0) - at(0)) < 1e-5 * std::max(1.0, std::abs(at(0))))
        return *point;
  }
  return std::nullopt;
}

/// Is it the event at which the last contact is lost?
bool lifts_off(const output::Run& run, const std::string& label) {
  return std::any_of(run.special_points.begin(), run.special_points.end(), [&](const auto& special) {
    return special.label == label && special.after == "no contact";
  });
}

continuation::LocusOptions options_of(const LocusRequest& request, const continuation::Point& special,
                                      int direction) {
  const continuation::Vector& p = special.p;
  const double unit = dynamic_cast<const RodProblem&>(*special.problem).as_given(1.0, 1);
  const bool angle = request.second == "load.angle";
  continuation::LocusOptions options;
  options.options.newton_tolerance = 1e-9;
  options.options.max_points = 1000;
  options.options.step_max = 0.5;
  options.options.lower = 0.05;  // below it rods of usual length have no tails left
  options.options.direction = direction;
  // Angles up to 8π, from where the contact arc vanishes; other parameters within a decade of where they are.
  const double low = request.from ? *request.from / unit
                     : angle      ? 0.05
                                  : 0.1 * p(1),
               high = request.to ? *request.to / unit
                      : angle    ? 8.0 * M_PI
                                 : 10.0 * p(1);
  options.second_lower = std::min(low, high);
  options.second_upper = std::max(low, high);
  options.second_scale = angle ? 2.0 : std::max(1e-3, 0.2 * std::abs(p(1)));
  return options;
}

}  // namespace

int run_locus(const LocusRequest& request) {
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  const output::Run run = output::read_run(request.run);
  const output::BranchRow& row = run.row(request.label);
  const equilibrium::Solution stored = run.points.get(request.label);
  scene::Scene scene = request.scene;
  if (!scene.continuation) throw InputError(scene.name + ": the run's scene has no [continuation] table");
  const std::string first = scene.continuation->parameter;
  if (first == request.second) throw InputError("the locus needs a second parameter other than " + first);
  scene = scene_of_point(scene, run, *run.points.find(request.label));
  const bool isolated = request.second == "load.angle" && lifts_off(run, request.label);
  const auto special =
      isolated ? std::nullopt : relocate(scene, stored, {first, request.second}, type_of(row.type));
  if (!special && !isolated)
    throw std::runtime_error("the special point " + request.label +
                             " could not be located again from its stored state");

  output::WriterOptions writer_options;
  writer_options.force = request.common.force;
  writer_options.command = "locus";
  writer_options.version = WINDLASS_VERSION;
  writer_options.parameter = first;
  writer_options.options = {{"of", request.label}, {"in", request.second}};
  if (request.second != "load.angle" && request.second != "load.tension")
    writer_options.extra_parameter = request.second;
  CommonOptions common = request.common;
  if (common.out.empty()) common.out = request.run.string() + "-locus-" + request.label;
  output::RunWriter writer = output::RunWriter::create(common.out, scene, writer_options);
  Progress progress(request.common.quiet);
  bool lost = false, stopped = false;
  int points = 0;
  if (isolated) {
    writer.add_point(output::make_row(stored, 1, 1, "", "contact", 0.0), stored);
    progress.note(
        "a point, not a curve: contact carries what the pulls do not balance, 2 T |sin(phi/2)| at least, so "
        "the "
        "last contact is lost at multiples of 2 pi only");
    points = 1;
  }
  for (const int direction : isolated ? std::vector<int>{} : std::vector{1, -1}) {
    continuation::LocusWalker walker(*special, options_of(request, *special, direction));
    int in_branch = 0;
    while (const auto point = walker.step()) {
      auto& problem = dynamic_cast<RodProblem&>(*point->problem);
      problem.error_estimate(point->x, point->p);
      equilibrium::Solution solution = equilibrium::record(problem, point->x, point->p);
      solution.model_reason = "a point of the locus of " + request.label;
      output::BranchRow out =
          output::make_row(solution, direction > 0 ? 1 : 2, ++in_branch, "",
                           point->type == LocusPoint::Type::event ? "contact" : "regular", point->ds);
      out.newton_iterations = point->newton_iterations;
      if (!writer_options.extra_parameter.empty()) out.parameter = problem.as_given(point->p(1), 1);
      writer.add_point(out, solution);
      ++points;
      if (!request.common.quiet && !request.common.json)
        std::printf("%-10s T = %.10g  phi = %.10g  R_tot = %.8g  %s%s\n", request.label.c_str(), solution.T,
                    solution.phi, solution.R_tot, solution.topology.c_str(),
                    point->note.empty() ? "" : ("  " + point->note).c_str());
      stopped = stopped || interrupted_by_user();
      if (stopped) walker.stop("interrupted");
    }
    progress.note("locus, direction " + std::string(direction > 0 ? "up" : "down") + ": " +
                  walker.end().reason);
    if (!walker.end().lost()) continue;
    lost = true;
    writer.add_lost_branch({direction > 0 ? 1 : 2,
                            request.label,
                            writer.rows().empty() ? 0.0 : writer.rows().back().T,
                            writer.rows().empty() ? 0.0 : writer.rows().back().phi,
                            walker.end().reason,
                            {}});
  }
  writer.finish(stopped ? "interrupted"
                : lost  ? "incomplete"
                        : "finished",
                {points, 0.0, 0.0, 0.0}, {{"points", points}});
  if (request.common.json) std::printf("%s\n", output::to_json(writer.info()).dump(2).c_str());
  return stopped ? interrupted : lost ? not_finished : done;
}

}  // namespace windlass::app
