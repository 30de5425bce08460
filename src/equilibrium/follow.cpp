#include "windlass/equilibrium/follow.hpp"

#include <algorithm>
#include <cmath>
#include <continuation/walker.hpp>

#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

Solution follow(scene::Scene scene, const Solution& stored, const std::string& key, double value) {
  if (stored.has_cylinder) scene.load.tension = stored.T, scene.load.angle = stored.phi;
  std::shared_ptr<RodProblem> problem = reopen(scene, stored.restart, {key});
  Vector x = stored.restart.state, p = problem->parameters();
  const double target = value / problem->as_given(1.0);
  if (p(0) != target) {
    const double from = p(0);
    continuation::Options options;
    options.target = target;
    options.direction = target < from ? -1 : 1;
    (target < from ? options.upper : options.lower) = from;  // a branch that folds back ends there
    options.parameter_scale = std::clamp(std::abs(target - from), 0.2, 1e3);
    options.detect_branch_points = false;
    options.newton_tolerance = 1e-9;
    options.max_points = 100;  // the target is near a stored point, or in the smooth regime of high tension
    continuation::Walker walker(problem, x, p, options);
    while (walker.step()) {
    }
    if (walker.end().kind != continuation::End::Kind::target)
      throw NoEquilibrium("the branch does not reach " + key + " = " + std::to_string(value) + ": " +
                          walker.end().reason);
    problem = std::dynamic_pointer_cast<RodProblem>(walker.problem());
    x = walker.x(), p = walker.p();
  }
  problem->error_estimate(x, p);
  Solution solution = record(*problem, x, p);
  solution.model_reason = "a point of a branch";
  solution.stability.emplace();
  solution.stability->index = solution.stability->inertia_index = problem->total_index(x, p);
  return solution;
}

}  // namespace windlass::equilibrium
