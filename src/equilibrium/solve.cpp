#include <chrono>
#include <cmath>

#include "windlass/equilibrium/newton.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"

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

bool symmetric(const scene::Scene& scene) { return scene.model.symmetry != scene::Symmetry::none; }

/// Number of unstable directions of a planar state in space.
int spatial_index(Started& planar) {
  Started lifted = lift(*planar.problem, planar.x, planar.p, true);
  return lifted.problem->total_index(lifted.x, lifted.p);
}

Solution solve_automatically(const scene::Scene& scene, const std::vector<std::string>& keys) {
  if (!scene.has_cylinder) {
    Started rod = cold_start(scene, true, symmetric(scene), keys);
    return finish(rod, "a strut may twist and leave the plane: Kirchhoff rod");
  }
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

Solution solve(const scene::Scene& scene) {
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
      solution = solve_automatically(scene, keys);
      break;
  }
  solution.seconds_solve = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solution.seconds_total = solution.seconds_solve;
  return solution;
}

}  // namespace windlass::equilibrium
