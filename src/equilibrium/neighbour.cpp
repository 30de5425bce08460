#include <continuation/diagram.hpp>

#include "windlass/equilibrium/start.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::equilibrium {

namespace {

/// Stops a diagram at the first stable state that reaches the wanted load.
class Seeker final : public continuation::DiagramObserver {
 public:
  explicit Seeker(double load) : load_(load) {}
  void on_point(const continuation::Branch& branch, const continuation::Point& point) override {
    if (branch.id == 0 || point.type != continuation::PointType::end || point.index != 0) return;
    if (std::abs(point.p(0) - load_) > 1e-9 * std::abs(load_)) return;
    x_ = point.x;
    p_ = point.p;
    problem_ = std::dynamic_pointer_cast<RodProblem>(point.problem->clone());
  }
  bool should_stop() override { return problem_ != nullptr; }
  std::optional<Started> found() const {
    if (!problem_) return std::nullopt;
    return Started{problem_, x_, p_, 0};
  }

 private:
  double load_;
  Vector x_, p_;
  std::shared_ptr<RodProblem> problem_;
};

/// Loads at which the flat (straight) state may still be stable, next one first: higher tensions, or no thrust.
std::vector<double> calmer_loads(const scene::Scene& scene, double goal) {
  if (!scene.has_cylinder) return {0.0};
  std::vector<double> loads;
  for (double factor = 1.5; factor < 40.0; factor *= 1.7) loads.push_back(goal * factor);
  return loads;
}

}  // namespace

std::optional<Started> stable_neighbour(Started& unstable) {
  const double goal = unstable.p(0);
  scene::Scene scene = unstable.problem->scene_at(unstable.p);
  const std::string key = load_key(scene);
  for (const double from : calmer_loads(scene, goal)) {
    scene::set_parameter(scene, key, from);
    try {
      Started above = cold_start(scene, true, unstable.problem->topology().half, unstable.problem->keys());
      if (above.problem->total_index(above.x, above.p) > 0) continue;
      continuation::Options options;
      options.target = goal;
      options.lower = std::min(goal, from);
      options.upper = std::max(goal, from);
      options.direction = goal < from ? -1 : 1;
      options.step_max = 0.2;
      options.max_points = 400;
      if (!scene.has_cylinder) options.parameter_scale = std::max(0.2, 0.2 * std::abs(goal - from));
      continuation::DiagramOptions limits;
      limits.max_branches = 6;
      Seeker seeker(goal);
      continuation::trace_diagram(above.problem, above.x, above.p, options, limits, seeker);
      return seeker.found();
    } catch (const std::exception&) {  // no such state at that load: try another one
    }
  }
  return std::nullopt;
}

}  // namespace windlass::equilibrium
