#include "app/branch_setup.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/record.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

namespace {

/// The rung of a branch. A coil of more than half a turn may leave the plane anywhere along its branch; the Kirchhoff rod
/// sees it, and its flat states are the planar ones.
bool needs_space(const scene::Scene& scene) {
  switch (scene.model.kind) {
    case scene::ModelKind::planar:
      return false;
    case scene::ModelKind::kirchhoff:
      return true;
    case scene::ModelKind::closed_form:
      throw InputError("model.kind = \"closed_form\": a branch needs \"planar\", \"kirchhoff\" or \"auto\"");
    case scene::ModelKind::automatic:
      break;
  }
  return !scene.has_cylinder || scene.load.angle > M_PI ||
         (scene.continuation && scene.continuation->parameter == "load.angle" &&
          scene.continuation->to > M_PI);
}

continuation::Options options_of(const scene::Scene& scene, double from) {
  const scene::Continuation& c = *scene.continuation;
  continuation::Options options;
  options.target = c.to;
  options.direction = c.to < from ? -1 : 1;
  options.lower = std::min(from, c.to);
  options.upper = std::max(from, c.to);
  const double range = std::abs(c.to - from);
  // Tensions up to 1e4 and shortenings below 1 are walked alike: the parameter's unit follows its range.
  options.parameter_scale = std::clamp(range / 5.0, 0.2, 1e3);
  if (c.step > 0.0) options.step = c.step;
  if (c.step_min > 0.0) options.step_min = c.step_min;
  if (c.step_max > 0.0) options.step_max = c.step_max;
  options.step = std::min(options.step, options.step_max);
  options.max_points = c.max_points;
  // Newton converges quadratically: the error left after an increment of 1e-9 is rounding.
  options.newton_tolerance = 1e-9;
  return options;
}

}  // namespace

BranchSetup set_up_branch(const BranchRequest& request) {
  scene::Scene scene = request.scene;
  if (!scene.continuation)
    throw InputError(scene.name + ": the scene has no [continuation] table (parameter, from, to)");
  const std::string key = scene.continuation->parameter;
  BranchSetup setup;
  if (request.run) {
    const output::Run run = output::read_run(*request.run);
    const equilibrium::Solution stored = run.points.get(request.label);
    if (stored.has_cylinder) scene.load.tension = stored.T, scene.load.angle = stored.phi;
    const std::vector<std::string> keys{key};
    setup.start.problem = equilibrium::reopen(scene, stored.restart, keys);
    setup.start.x = stored.restart.state;
    setup.start.p = setup.start.problem->parameters();
  } else {
    if (scene.continuation->from != 0.0 || key == "load.angle")
      scene::set_parameter(scene, key, scene.continuation->from);
    // The straight strut's thrust is undetermined; its buckled states end there.
    constexpr double least_shortening = 1e-5;
    if (key == "ends.shortening" && scene.ends.shortening.value_or(0.0) < least_shortening)
      scene.ends.shortening = least_shortening;
    setup.start = equilibrium::cold_start(scene, needs_space(scene),
                                          scene.model.symmetry != scene::Symmetry::none, {key});
  }
  setup.options = options_of(scene, setup.start.p(0));
  return setup;
}

output::RunWriter open_run(const BranchRequest& request, const std::string& command) {
  if (request.common.resume)
    throw InputError("--resume: not supported yet; restart from a stored point with `continue RUN LABEL`");
  output::WriterOptions options;
  options.force = request.common.force;
  options.command = command;
  options.version = WINDLASS_VERSION;
  if (request.scene.continuation) {
    const std::string& key = request.scene.continuation->parameter;
    if (key != "load.tension" && key != "load.angle" && key != "ends.shortening")
      options.extra_parameter = key;
  }
  return output::RunWriter::create(output_folder(request.common, request.scene), request.scene, options);
}

}  // namespace windlass::app
