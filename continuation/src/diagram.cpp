#include "continuation/diagram.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "way_back.hpp"

namespace continuation {
namespace {

bool is_special(const Point& point) {
  return point.type == PointType::fold || point.type == PointType::branch_point ||
         point.type == PointType::event || point.type == PointType::hopf;
}

/// Branches are numbered from 1 for people.
std::string branch_name(int id) { return "branch " + std::to_string(id + 1); }

class Tracer {
 public:
  Tracer(DiagramState state, const Options& options, const DiagramOptions& limits, DiagramObserver& observer)
      : options_(options), limits_(limits), observer_(observer), state_(std::move(state)) {}

  Diagram trace() {
    while (!diagram().stopped && (state_.walker || start_branch())) {
      walk();
      if (!diagram().stopped) observer_.on_rest(state_);  // a stop has been preceded by its own
    }
    return std::move(diagram());
  }

 private:
  /// Takes the next pending branch; false when there is none left, or no more may be walked.
  bool start_branch() {
    while (!state_.pending.empty()) {
      const PendingBranch next = std::move(state_.pending.front());
      state_.pending.pop_front();
      if (next.back && diagram().branches[0].end.kind == End::Kind::closed) continue;
      if (next.special >= 0 && arrived(next)) continue;
      if (static_cast<int>(diagram().branches.size()) >= limits_.max_branches) {
        diagram().lost.push_back("max_branches = " + std::to_string(limits_.max_branches) + " reached, " +
                                 std::to_string(state_.pending.size() + 1) + " arms not walked");
        state_.pending.clear();
        return false;
      }
      Options options = options_;
      if (next.back) options.direction = -options.direction;
      if (next.special < 0) {
        state_.walker.emplace(next.start.problem, next.start.x, next.start.p, options);
      } else {
        state_.walker.emplace(next.start.problem, next.start.x, next.start.p, next.start.tangent, options);
      }
      const int id = static_cast<int>(diagram().branches.size());
      const std::string origin = next.special < 0 ? "" : special(next.special).point.label;
      diagram().branches.push_back(Branch{id, next.depth, origin, next.start.count, 0, {}});
      state_.first_special = static_cast<int>(diagram().specials.size());
      observer_.on_branch_start(branch());
      if (id == 0 && limits_.from_behind) return report_behind(next.start);
      return true;
    }
    return false;
  }

  /// What lies behind the start, from its far end on; false: stopped, with nothing reported.
  bool report_behind(const Arm& start) {
    WayBack behind(start, options_);
    while (const Point* point = behind.step()) {
      observer_.on_way_back(*point);
      if (!observer_.should_stop()) continue;
      diagram().stopped = true;
      end_branch(End{End::Kind::stopped, "stopped"});
      return false;
    }
    if (behind.end().kind != End::Kind::target)
      diagram().lost.push_back(branch_name(0) + ": back from its start, " + behind.end().reason);
    for (Point& point : behind.reversed()) {
      ++branch().points;
      report(std::move(point));
    }
    reported_start_ = true;
    return true;
  }

  /// Goes along the branch in progress to its end, or to where the observer stops it.
  void walk() {
    Walker& walker = *state_.walker;
    while (std::optional<Point> point = walker.step()) {
      if (std::exchange(reported_start_, false) && point->type == PointType::start) continue;
      ++branch().points;
      if (const std::optional<End> joined = report(std::move(*point))) return end_branch(*joined);
      if (!walker.at_rest()) continue;
      if (observer_.should_stop()) {
        observer_.on_rest(state_);
        diagram().stopped = true;
        return end_branch(walker.end() ? walker.end() : End{End::Kind::stopped, "stopped"});
      }
      observer_.on_rest(state_);
    }
    end_branch(walker.end());
  }

  /// Hands a point out; returns the branch's end if it is a special point of another branch.
  std::optional<End> report(Point point) {
    if (point.type == PointType::start && !point.note.empty())
      diagram().notes.push_back(branch_name(branch().id) + ": " + point.note);
    if (!is_special(point)) {
      observer_.on_point(branch(), point);
      return std::nullopt;
    }
    Vector fingerprint = point.problem->fingerprint(point.x, point.p);
    if (SpecialPoint* known = find(point, fingerprint)) {
      point.label = known->point.label;
      // The branch that goes the other way from a start on a branch point has not come along any arm of it.
      if (point.type == PointType::branch_point && point.path_length == 0.0) {
        observer_.on_point(branch(), point);
        return std::nullopt;
      }
      const bool through_itself = known->branch == branch().id;
      const auto came_along = [&](Tangent way) {
        known->arrivals.push_back(std::move(way));
        known->arrival_points.push_back(point);
        known->arrival_points.back().branch_point.reset();  // its "known" branch is the one looked for here
      };
      came_along(Tangent{-point.tangent.x, -point.tangent.p});
      if (through_itself) came_along(point.tangent);
      observer_.on_point(branch(), point);
      if (through_itself) return std::nullopt;
      return End{End::Kind::joined, "joins " + branch_name(known->branch) + " at " + known->point.label};
    }
    point.label = next_label(point.type);
    observer_.on_point(branch(), point);
    observer_.on_special_point(branch(), point);
    diagram().specials.push_back(SpecialPoint{std::move(point), branch().id, std::move(fingerprint), {}, {}});
    return std::nullopt;
  }

  void end_branch(const End& end) {
    branch().end = end;
    if (end.lost()) diagram().lost.push_back(branch_name(branch().id) + ": " + end.reason);
    observer_.on_branch_end(branch());
    state_.walker.reset();
    if (!diagram().stopped && limits_.arms) enqueue_arms();
  }

  void enqueue_arms() {
    const int depth = branch().depth;
    for (int i = state_.first_special; i < static_cast<int>(diagram().specials.size()); ++i) {
      const Point& point = special(i).point;
      if (point.type != PointType::branch_point) continue;
      if (limits_.breaking_arms_of_stable && broken(special(i)) &&
          std::min(point.index, point.index_after) > 0)
        continue;
      if (depth >= limits_.max_depth) {
        diagram().lost.push_back(point.label + ": max_depth = " + std::to_string(limits_.max_depth) +
                                 " reached, its arms are not walked");
        continue;
      }
      Arms arms = switch_branch(point, options_);
      for (const std::string& failure : arms.failures) diagram().lost.push_back(point.label + ": " + failure);
      for (const std::string& arm : arms.inadmissible)
        diagram().inadmissible.push_back(point.label + ": " + arm);
      for (Arm& arm : arms.arms) state_.pending.push_back({std::move(arm), i, depth + 1, false});
    }
  }

  /// Is the symmetry of the diagram's problem broken at this point, or on its branch already?
  bool broken(const SpecialPoint& point) const {
    if (point.point.breaking) return true;
    const std::string& origin = state_.diagram.branches[static_cast<std::size_t>(point.branch)].origin;
    const auto& all = state_.diagram.specials;
    const auto from = std::find_if(all.begin(), all.end(),
                                   [&](const SpecialPoint& other) { return other.point.label == origin; });
    return !origin.empty() && from != all.end() && broken(*from);
  }

  // A branch that joined the arm's branch point came along this very arm.
  bool arrived(const PendingBranch& next) {
    const Arm& arm = next.start;
    const SpecialPoint& origin = special(next.special);
    const Vector fingerprint = arm.problem->fingerprint(arm.x, arm.p);
    if (fingerprint.size() != origin.fingerprint.size()) return false;
    const auto distance = [&](const Vector& print, const Vector& p, const Vector& other, const Vector& q) {
      return (print - other).norm() / options_.state_scale + (p - q).norm() / options_.parameter_scale;
    };
    const double moved = distance(fingerprint, arm.p, origin.fingerprint, origin.point.p);
    for (std::size_t i = 0; i < origin.arrivals.size(); ++i) {
      ArmFailure failure;
      const std::optional<Arm> back =
          start_arm(origin.arrival_points[i], origin.arrivals[i], arm.epsilon, options_, failure);
      if (!back) continue;
      const Vector other = back->problem->fingerprint(back->x, back->p);
      if (other.size() != fingerprint.size()) continue;
      if (distance(other, back->p, fingerprint, arm.p) <= 0.05 * moved + 1e-7) return true;
    }
    return false;
  }

  /// The same solution itself, not its mirror image.
  bool same_state(const Point& a, const Point& b) const {
    constexpr double same = 1e-5;  // free along the null vector, to within its curvature
    return a.x.size() == b.x.size() &&
           (a.x - b.x).norm() <=
               same * (options_.state_scale * std::sqrt(static_cast<double>(a.x.size())) + a.x.norm());
  }

  SpecialPoint* find(const Point& point, const Vector& fingerprint) {
    for (SpecialPoint& known : diagram().specials) {
      if (known.point.type != point.type) continue;
      // A branch may go through itself at a branch point; a mirror image there is another point of it.
      if (known.branch == branch().id &&
          (point.type != PointType::branch_point || !same_state(known.point, point)))
        continue;
      if (same_fingerprint(known.point.p, point.p, 1e-6, options_.parameter_scale) &&
          same_fingerprint(known.fingerprint, fingerprint, 1e-5, options_.state_scale))
        return &known;
    }
    return nullptr;
  }

  std::string next_label(PointType type) {
    if (type == PointType::fold) return "F" + std::to_string(++state_.folds);
    if (type == PointType::branch_point) return "B" + std::to_string(++state_.branch_points);
    if (type == PointType::hopf) return "H" + std::to_string(++state_.hopf_points);
    return "E" + std::to_string(++state_.events);
  }

  Diagram& diagram() { return state_.diagram; }
  Branch& branch() { return state_.diagram.branches.back(); }  // the one in progress
  SpecialPoint& special(int i) { return state_.diagram.specials[static_cast<std::size_t>(i)]; }

  Options options_;
  DiagramOptions limits_;
  DiagramObserver& observer_;
  DiagramState state_;
  bool reported_start_ = false;  ///< of the branch in progress, with what lies behind it
};

}  // namespace

Diagram trace_diagram(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
                      const Options& options, const DiagramOptions& diagram_options,
                      DiagramObserver& observer) {
  DiagramState state;
  if (diagram_options.both_ways) state.pending.push_back({{problem->clone(), x, p, {}, 0.0, 1}, -1, 0, true});
  state.pending.push_front({{std::move(problem), x, p, {}, 0.0, 1}, -1, 0, false});
  return resume_diagram(std::move(state), options, diagram_options, observer);
}

Diagram resume_diagram(DiagramState state, const Options& options, const DiagramOptions& diagram_options,
                       DiagramObserver& observer) {
  return Tracer(std::move(state), options, diagram_options, observer).trace();
}

}  // namespace continuation
