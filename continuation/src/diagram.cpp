#include "continuation/diagram.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace continuation {
namespace {

struct Pending {
  Arm arm;
  std::size_t special;  // the branch point it leaves
  int depth;
};

class Tracer {
 public:
  Tracer(const Options& options, const DiagramOptions& limits, DiagramObserver& observer)
      : options_(options), limits_(limits), observer_(observer) {}

  Diagram trace(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p) {
    const std::shared_ptr<Problem> untouched = limits_.both_ways ? problem->clone() : nullptr;
    Walker first(std::move(problem), x, p, options_);
    walk(first, 0, "", 1);
    if (limits_.both_ways && !diagram_.stopped && diagram_.branches[0].end.kind != End::Kind::closed) {
      Options back = options_;
      back.direction = -options_.direction;
      Walker second(untouched, x, p, back);
      walk(second, 0, "", 1);
    }
    while (!diagram_.stopped && !pending_.empty()) {
      const Pending next = std::move(pending_.front());
      pending_.pop_front();
      if (arrived(next)) continue;
      if (static_cast<int>(diagram_.branches.size()) >= limits_.max_branches) {
        diagram_.lost.push_back("max_branches = " + std::to_string(limits_.max_branches) + " reached, " +
                                std::to_string(pending_.size() + 1) + " arms not walked");
        break;
      }
      const std::string origin = diagram_.specials[next.special].point.label;
      Walker walker(next.arm.problem, next.arm.x, next.arm.p, next.arm.tangent, options_);
      walk(walker, next.depth, origin, next.arm.count);
    }
    return std::move(diagram_);
  }

 private:
  void walk(Walker& walker, int depth, const std::string& origin, int count) {
    const int id = static_cast<int>(diagram_.branches.size());
    diagram_.branches.push_back(Branch{id, depth, origin, count, 0, {}});
    observer_.on_branch_start(diagram_.branches.back());
    const std::size_t first_new = diagram_.specials.size();
    End joined;
    while (std::optional<Point> point = walker.step()) {
      ++branch(id).points;
      const bool is_special = point->type == PointType::fold || point->type == PointType::branch_point ||
                              point->type == PointType::event;
      if (!is_special) {
        observer_.on_point(branch(id), *point);
      } else {
        Vector fingerprint = point->problem->fingerprint(point->x, point->p);
        SpecialPoint* known = find(*point, fingerprint, id);
        if (known) {
          point->label = known->point.label;
          known->arrivals.push_back(Tangent{-point->tangent.x, -point->tangent.p});
          known->arrival_points.push_back(*point);
          known->arrival_points.back().branch_point.reset();  // its "known" branch is the one looked for here
          observer_.on_point(branch(id), *point);
          joined = End{End::Kind::joined,
                       "joins branch " + std::to_string(known->branch) + " at " + known->point.label};
          break;
        }
        relabel(*point);
        observer_.on_point(branch(id), *point);
        observer_.on_special_point(branch(id), *point);
        diagram_.specials.push_back(SpecialPoint{std::move(*point), id, std::move(fingerprint), {}, {}});
      }
      if (observer_.should_stop()) {
        diagram_.stopped = true;
        walker.stop("stopped");
      }
    }
    branch(id).end = joined ? joined : walker.end();
    if (branch(id).end.lost())
      diagram_.lost.push_back("branch " + std::to_string(id) + ": " + branch(id).end.reason);
    observer_.on_branch_end(branch(id));
    if (!diagram_.stopped) enqueue(first_new, depth);
  }

  void enqueue(std::size_t first_new, int depth) {
    for (std::size_t i = first_new; i < diagram_.specials.size(); ++i) {
      const Point& point = diagram_.specials[i].point;
      if (point.type != PointType::branch_point) continue;
      if (depth >= limits_.max_depth) {
        diagram_.lost.push_back(point.label + ": max_depth = " + std::to_string(limits_.max_depth) +
                                " reached, its arms are not walked");
        continue;
      }
      Arms arms = switch_branch(point, options_);
      for (const std::string& failure : arms.failures) diagram_.lost.push_back(point.label + ": " + failure);
      for (Arm& arm : arms.arms) pending_.push_back(Pending{std::move(arm), i, depth + 1});
    }
  }

  // A branch that joined the arm's branch point came along this very arm.
  bool arrived(const Pending& next) {
    const SpecialPoint& special = diagram_.specials[next.special];
    const Vector fingerprint = next.arm.problem->fingerprint(next.arm.x, next.arm.p);
    if (fingerprint.size() != special.fingerprint.size()) return false;
    const double moved = (fingerprint - special.fingerprint).norm() + (next.arm.p - special.point.p).norm();
    for (std::size_t i = 0; i < special.arrivals.size(); ++i) {
      std::string failure;
      const std::optional<Arm> back =
          start_arm(special.arrival_points[i], special.arrivals[i], next.arm.epsilon, options_, failure);
      if (!back) continue;
      const Vector other = back->problem->fingerprint(back->x, back->p);
      if (other.size() != fingerprint.size()) continue;
      if ((other - fingerprint).norm() + (back->p - next.arm.p).norm() <= 0.05 * moved + 1e-7) return true;
    }
    return false;
  }

  SpecialPoint* find(const Point& point, const Vector& fingerprint, int branch) {
    for (SpecialPoint& known : diagram_.specials) {
      if (known.branch == branch || known.point.type != point.type) continue;
      if (same_fingerprint(known.point.p, point.p, 1e-6) &&
          same_fingerprint(known.fingerprint, fingerprint, 1e-5))
        return &known;
    }
    return nullptr;
  }

  void relabel(Point& point) {
    switch (point.type) {
      case PointType::fold:
        point.label = "F" + std::to_string(++folds_);
        break;
      case PointType::branch_point:
        point.label = "B" + std::to_string(++branch_points_);
        break;
      default:
        point.label = "E" + std::to_string(++events_);
    }
  }

  Branch& branch(int id) { return diagram_.branches[static_cast<std::size_t>(id)]; }

  Options options_;
  DiagramOptions limits_;
  DiagramObserver& observer_;
  Diagram diagram_;
  std::deque<Pending> pending_;
  int folds_ = 0, branch_points_ = 0, events_ = 0;
};

}  // namespace

Diagram trace_diagram(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
                      const Options& options, const DiagramOptions& diagram_options,
                      DiagramObserver& observer) {
  return Tracer(options, diagram_options, observer).trace(std::move(problem), x, p);
}

}  // namespace continuation
