#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <continuation/walker.hpp>

#include "windlass/equilibrium/newton.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/resolved.hpp"

namespace windlass::equilibrium {

using scene::ModelKind;

namespace {

/// Puts a state through SNES: the polish of the cold start is checked by PETSc's own convergence criteria.
void confirm(Started& started) {
  NewtonSolver newton;
  const NewtonResult result =
      newton.solve(started.problem->chain_to_factor(), started.x, started.problem->loads(started.p));
  if (!result.converged) throw NoEquilibrium("SNES did not accept the state: " + result.reason);
  started.newton_iterations += result.iterations;
}

Solution finish(Started& started, const std::string& reason) {
  confirm(started);
  started.problem->error_estimate(started.x, started.p);
  Solution solution = record(*started.problem, started.x, started.p);
  solution.newton_iterations = started.newton_iterations;
  solution.model_reason = reason;
  return solution;
}

bool symmetric(const scene::Scene& scene) { return scene.half_turn(); }

/// Number of unstable directions of a planar state in space.
int spatial_index(Started& planar) {
  Started lifted = lift(*planar.problem, planar.x, planar.p, true);
  return lifted.problem->total_index(lifted.x, lifted.p);
}

/// Least thrust at which the straight strut may bow, up to that of twice Euler's; nullopt: none, or unstable without any.
std::optional<double> buckling_thrust(const scene::Scene& scene) {
  scene::Scene idle = scene;
  idle.load.thrust = 0.0;
  Started start = cold_start(idle, true, true, {"load.thrust"});
  if (start.problem->total_index(start.x, start.p) > 0) return std::nullopt;
  continuation::Options options;
  const double euler =
      4.0 * M_PI * M_PI * scene.rod.bending_stiffness / (scene.rod.length * scene.rod.length);
  options.target = options.upper = 2.0 * euler;
  options.parameter_scale = euler;
  options.detect_events = false;
  continuation::Walker walker(start.problem, start.x, start.p, options);
  while (const auto point = walker.step())
    if (point->type == continuation::PointType::branch_point) return point->p(0);
  return std::nullopt;
}

Solution solve_strut(const scene::Scene& scene, const std::vector<std::string>& keys) {
  Started rod = cold_start(scene, true, symmetric(scene), keys);
  if (scene.ends.shortening) return finish(rod, "a strut may twist and leave the plane: Kirchhoff rod");
  const int index = rod.problem->total_index(rod.x, rod.p);
  if (index == 0) return finish(rod, "the straight strut is stable under this thrust");
  const std::string unstable =
      "the straight strut is unstable under this thrust (index " + std::to_string(index) + ")";
  if (auto buckled = stable_neighbour(rod))
    return finish(*buckled, unstable + "; this is the state it leaves for");
  return finish(
      rod, unstable + "; no stable state was found on the arms that leave it, so this is the straight one");
}

Solution solve_automatically(const scene::Scene& scene, const std::vector<std::string>& keys) {
  Started planar = cold_start(scene, false, true, keys);
  const int index = spatial_index(planar);
  if (index == 0 && symmetric(scene)) {
    if (scene.rod.infinite() && rod::capstan::line_contact(scene.load.tension, scene.load.angle)) {
      Solution solution = finish(planar, "");
      solution.model = "closed_form";
      solution.model_reason =
          "infinite tails and a line contact: the closed form is exact, and the flat state is stable in "
          "space";
      return solution;
    }
    return finish(planar, "the flat state is stable against all perturbations of the Kirchhoff rod");
  }
  Started rod = lift(*planar.problem, planar.x, planar.p, symmetric(scene));
  if (index == 0) return finish(rod, "the full chain was asked for (model.symmetry = \"none\")");
  const std::string unstable = "the flat state is unstable in space (index " + std::to_string(index) + ")";
  if (auto helical = stable_neighbour(rod))
    return finish(*helical, unstable + "; this is the state it leaves for");
  return finish(rod,
                unstable + "; no stable state was found on the arms that leave it, so this is the flat one");
}

}  // namespace

std::string load_key(const scene::Scene& scene) {
  if (scene.has_cylinder) return "load.tension";
  return scene.ends.shortening ? "ends.shortening" : "load.thrust";
}

bool thrust_undetermined(const scene::Scene& scene) {
  return !scene.has_cylinder && scene.ends.shortening == 0.0;
}

scene::Scene determinate(scene::Scene scene) {
  if (!thrust_undetermined(scene)) return scene;
  scene.ends.shortening.reset();
  scene.load.thrust = 0.0;
  if (scene.continuation && scene.continuation->parameter == "ends.shortening") scene.continuation.reset();
  scene.resolved_toml = scene::to_toml(scene);
  return scene;
}

Solution solve(const scene::Scene& asked) {
  const scene::Scene scene = determinate(asked);
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<std::string> keys{load_key(scene)};
  Solution solution;
  switch (scene.model.kind) {
    case ModelKind::closed_form: {
      if (!scene.has_cylinder || !scene.rod.infinite())
        throw InputError("model.kind = \"closed_form\": needs a cylinder and rod.length = \"inf\"");
      if (!rod::capstan::line_contact(scene.load.tension, scene.load.angle))
        throw NoEquilibrium(
            "the closed form has no line contact at this tension; model.kind = \"planar\" goes on");
      Started planar = cold_start(scene, false, true, keys);
      solution = finish(planar, "asked for");
      solution.model = "closed_form";
      break;
    }
    case ModelKind::planar: {
      Started planar = cold_start(scene, false, symmetric(scene), keys);
      solution = finish(planar, "asked for");
      break;
    }
    case ModelKind::kirchhoff: {
      Started rod = cold_start(scene, true, symmetric(scene), keys);
      solution = finish(rod, "asked for");
      break;
    }
    case ModelKind::automatic:
      solution = scene.has_cylinder ? solve_automatically(scene, keys) : solve_strut(scene, keys);
      break;
  }
  if (thrust_undetermined(asked)) {
    const std::optional<double> most = buckling_thrust(scene);
    solution.model_reason = fmt::format(
        "without shortening an inextensible strut is straight and {}; shown is the one without thrust",
        most ? fmt::format("carries any thrust up to its buckling load {:.12g}", *most)
             : "already unstable without thrust, by its twist");
  }
  solution.seconds_solve = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solution.seconds_total = solution.seconds_solve;
  return solution;
}

}  // namespace windlass::equilibrium
