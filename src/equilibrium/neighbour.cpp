#include <continuation/diagram.hpp>

#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

namespace {

/// Stops a diagram at the first stable state that reaches the wanted tension.
class Seeker final : public continuation::DiagramObserver {
 public:
  explicit Seeker(double tension) : tension_(tension) {}
  void on_point(const continuation::Branch& branch, const continuation::Point& point) override {
    if (branch.id == 0 || point.type != continuation::PointType::end || point.index != 0) return;
    if (std::abs(point.p(0) - tension_) > 1e-9 * tension_) return;
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
  double tension_;
  Vector x_, p_;
  std::shared_ptr<RodProblem> problem_;
};

}  // namespace

std::optional<Started> stable_neighbour(Started& unstable) {
  const double goal = unstable.p(0);
  scene::Scene scene = unstable.problem->scene_at(unstable.p);
  for (double factor = 1.5; factor < 40.0; factor *= 1.7) {
    scene.load.tension = goal * factor;
    try {
      Started above = cold_start(scene, true, unstable.problem->topology().half, unstable.problem->keys());
      if (above.problem->total_index(above.x, above.p) > 0) continue;
      continuation::Options options;
      options.target = goal;
      options.lower = goal;
      options.upper = scene.load.tension;
      options.direction = -1;
      options.step_max = 0.2;
      options.max_points = 400;
      continuation::DiagramOptions limits;
      limits.max_branches = 6;
      Seeker seeker(goal);
      continuation::trace_diagram(above.problem, above.x, above.p, options, limits, seeker);
      return seeker.found();
    } catch (const std::exception&) {  // no such state at that tension: try a higher one
    }
  }
  return std::nullopt;
}

}  // namespace windlass::equilibrium
