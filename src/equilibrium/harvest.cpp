#include "harvest.hpp"

#include <cmath>

namespace windlass::equilibrium {

using continuation::Branch;
using continuation::Point;
using continuation::PointType;

bool Harvest::reach(const std::shared_ptr<continuation::Problem>& problem, const Place& from,
                    double direction) {
  continuation::Options options = options_;
  options.target = goal_;
  options.lower = -std::numeric_limits<double>::infinity();
  options.upper = std::numeric_limits<double>::infinity();
  options.detect_branch_points = false;
  options.max_points = 40;  // the goal lies within one step of the diagram's
  std::optional<continuation::Walker> walker;
  if (from.tangent.x.size() > 0) {
    const continuation::Tangent way{direction * from.tangent.x, direction * from.tangent.p};
    walker.emplace(problem->clone(), from.x, from.p, way, options);
  } else {
    options.direction = goal_ < from.p(0) ? -1 : 1;
    walker.emplace(problem->clone(), from.x, from.p, options);
  }
  if (from.p(0) != goal_) {
    while (walker->step()) {
    }
    if (walker->end().kind != continuation::End::Kind::target) return false;
  }
  states_.push_back({std::dynamic_pointer_cast<RodProblem>(walker->problem()), walker->x(), walker->p(), 0});
  return true;
}

void Harvest::on_point(const Branch&, const Point& point) {
  // A branch point is passed like any other point, and one that breaks the symmetry belongs to another problem.
  if (point.type == PointType::branch_point) return;
  if (point.type == PointType::regular) ++points_;
  const Place here{point.problem, point.x, point.p, point.tangent};
  if (last_ && between(last_->p(0), point.p(0)) && last_->p(0) != goal_) {
    // A fold is reached from the point before, on whose mesh it was found; any other is left backwards.
    if (point.type == PointType::fold)
      reach(point.problem, *last_, 1.0);
    else
      reach(point.problem, here, -1.0);
  }
  if (point.type != PointType::event) {
    last_ = here;
    return;
  }
  last_.reset();
  if (!point.next_problem) return;
  // The branch goes on a little beside the event: what lies between belongs to the new contacts.
  last_ = Place{point.next_problem, point.next_x, point.next_p, {}};
  if (between(point.p(0), point.next_p(0)) && point.p(0) != goal_) reach(point.next_problem, *last_, 1.0);
}

}  // namespace windlass::equilibrium
