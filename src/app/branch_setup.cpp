#include "app/branch_setup.hpp"

#include <algorithm>
#include <cmath>

#include "app/stored_point.hpp"
#include "windlass/equilibrium/opening.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/search.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/units.hpp"

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
  return !scene.has_cylinder || scene.ends.guided() || scene.load.angle > M_PI ||
         (scene.continuation && scene.continuation->parameter == "load.angle" &&
          scene.continuation->to > M_PI);
}

/// @param scene  in the units it is solved in
continuation::Options options_of(const scene::Scene& scene) {
  const scene::Continuation& c = *scene.continuation;
  const double from = scene::get_parameter(scene, c.parameter);
  continuation::Options options;
  options.target = c.to;
  options.direction = c.to < from ? -1 : 1;
  options.lower = std::min(from, c.to);
  options.upper = std::max(from, c.to);
  const double range = std::abs(c.to - from);
  // Tensions up to 1e4 and shortenings below 1 are walked alike: the parameter's unit follows its range. That of an axial
  // stiffness has no bounds, for stiff rods hardly answer to it.
  const double most = c.parameter == "rod.axial_stiffness" ? HUGE_VAL : 1e3;
  options.parameter_scale = std::clamp(range / 5.0, 0.2, most);
  if (c.step > 0.0) options.step = c.step;
  if (c.step_min > 0.0) options.step_min = c.step_min;
  // Longer steps save next to nothing, for more of them are refused, and leave few points on a branch to look at. Points of
  // rods that touch themselves cost ten times as much, and each of theirs counts.
  const double usual_step_max = scene.strand_radius() > 0.0 ? 0.5 : 0.25;
  options.step_max = c.step_max > 0.0 ? c.step_max : usual_step_max;
  options.step = std::min(options.step, options.step_max);
  options.max_points = c.max_points;
  // What a correction of 1e-9 leaves is rounding: by the state's own factorisation at once, by an old one as the stopping rule
  // sees to.
  options.newton_tolerance = 1e-9;
  return options;
}

/// At a fold or branch point no state is alone at its parameter: the branch that was walked there is taken up a little
/// further on, or, where it turns back, a little before.
equilibrium::Started beside(equilibrium::Started at, int direction) {
  const double here = at.p(0);
  for (const double offset : {1e-4, -1e-4, 1e-3, -1e-3, 1e-2, -1e-2}) {
    equilibrium::Started next = at;
    next.p(0) = here + direction * offset * std::max(1.0, std::abs(here));
    if (at.problem->polish(next.x, next.p) >= 0) return next;
  }
  throw equilibrium::NoEquilibrium("no state was found beside the singular point");
}

/// From nothing. A thick coil of low tension has several states, and what is found first may be unstable or nothing: there
/// branches start where `solve` ends.
equilibrium::Started found_first(const scene::Scene& scene, const std::vector<std::string>& keys) {
  const bool thick_coil =
      scene.has_cylinder && scene.strand_radius() > 0.0 && !scene.knot.tied() && !scene.slides();
  const auto cold = [&] {
    return equilibrium::cold_start(scene, needs_space(scene), scene.half_turn(), keys);
  };
  if (!thick_coil || !needs_space(scene)) return cold();
  try {
    equilibrium::Started start = cold();
    if (start.problem->total_index(start.x, start.p) == 0) return start;
    return equilibrium::stable_state(scene, keys).value_or(start);
  } catch (const equilibrium::NoEquilibrium&) {
    if (auto stable = equilibrium::stable_state(scene, keys)) return *stable;
    throw;
  }
}

}  // namespace

BranchSetup set_up_branch(const BranchRequest& request) {
  BranchSetup setup;
  scene::Scene& scene = setup.scene = request.scene;
  if (!scene.continuation)
    throw InputError(scene.name + ": the scene has no [continuation] table (parameter, from, to)");
  setup.key = scene.continuation->parameter;
  if (request.run) {
    const output::Run run = output::read_run(*request.run);
    setup.stored = run.points.get(request.label).restart;
    const std::size_t position = *run.points.find(request.label);
    const output::PointStore::Key& key = run.points.keys().at(position);
    const std::string type = run.row(output::point_name(key.branch, key.point, "")).type;
    setup.singular = type == "fold" || type == "branch_point";
    scene = scene_of_point(scene, run, position);
  } else {
    if (scene.continuation->from != 0.0 || setup.key == "load.angle")
      scene::set_parameter(scene, setup.key, scene.continuation->from);
    // The straight strut's thrust is undetermined; its buckled states end there.
    constexpr double least_shortening = 1e-5;
    if (setup.key == "ends.shortening" && scene.ends.shortening.value_or(0.0) < least_shortening)
      scene.ends.shortening = least_shortening;
  }
  const scene::Units units =
      setup.stored ? equilibrium::units_of(setup.stored->chain) : scene::natural_units(scene);
  setup.options = options_of(scene::in_units(scene, units));
  return setup;
}

FirstState first_state(const BranchSetup& setup) {
  const std::vector<std::string> keys{setup.key};
  if (!setup.stored) {
    const bool half = setup.scene.half_turn();
    if (auto knot =
            equilibrium::knot_between(setup.scene, half, setup.key, setup.options.lower, setup.options.upper))
      return {*knot, true};
    return {found_first(setup.scene, keys)};
  }
  const auto problem = equilibrium::reopen(setup.scene, *setup.stored, keys);
  equilibrium::Started start{problem, setup.stored->state, problem->parameters(), 0};
  if (setup.singular) return {beside(start, setup.options.direction)};
  if (!equilibrium::leave_event(*start.problem, start.x, start.p))
    throw equilibrium::NoEquilibrium("no state was found beside the event");
  return {start};
}

}  // namespace windlass::app
