#pragma once

#include <deque>
#include <string>
#include <vector>

#include "continuation/branch_switch.hpp"
#include "continuation/walker.hpp"

namespace continuation {

struct DiagramOptions {
  bool both_ways = false;  ///< the first branch is walked in both directions from the start
  bool arms = true;        ///< branches that leave branch points are walked, too
  int max_branches = 50;   ///< branches in all
  int max_depth = 3;       ///< branch points between the first branch and the last arms
  /// Of points that break the problem's symmetry, and on branches that have broken it, the arms are walked where stability
  /// is lost or won, so that all that a stable branch leads to is seen; the whole tree belongs to the unrestricted problem.
  bool breaking_arms_of_stable = true;
  /// The start lies inside the first branch: it is walked back to the bound behind it, and reported from there on. Where it
  /// does not lead there it begins where it ends, and that is lost.
  bool from_behind = false;
};

struct Branch {
  int id = 0;          ///< place in Diagram::branches
  int depth = 0;       ///< 0: the first branch
  std::string origin;  ///< label of the branch point it leaves; empty for the first branch
  int count = 1;       ///< mirror images it stands for
  int points = 0;      ///< points yielded
  End end;
};

struct SpecialPoint {
  Point point;  ///< with a label counted over the diagram
  int branch = 0;
  Vector fingerprint;
  std::vector<Tangent> arrivals;      ///< of a joining branch, back along it; of the branch itself, both ways
  std::vector<Point> arrival_points;  ///< and that branch's own solution there
};

struct Diagram {
  std::vector<Branch> branches;
  std::vector<SpecialPoint> specials;
  std::vector<std::string>
      lost;  ///< what failed: lost branches, arms that could not be started, limits reached
  std::vector<std::string> inadmissible;  ///< arms of branch points on which an event function is negative
  std::vector<std::string> notes;         ///< what could not be looked for, and why
  bool stopped = false;                   ///< by should_stop
};

/// A branch not walked yet: the first one, its other direction, or an arm of a branch point.
struct PendingBranch {
  Arm start;        ///< the first branch has neither tangent nor epsilon
  int special = 0;  ///< place in Diagram::specials of the branch point it leaves; −1: the start
  int depth = 0;
  bool back = false;  ///< the first branch against Options::direction
};

/// A diagram between two steps, as data: everything needed to go on with it.
struct DiagramState {
  Diagram diagram;  ///< so far; its last branch is in progress if there is a walker
  std::deque<PendingBranch> pending;
  std::optional<Walker> walker;
  int first_special = 0;  ///< of the branch in progress, place in Diagram::specials
  int folds = 0, branch_points = 0, events = 0, hopf_points = 0;  ///< labels given
};

/// Receives the diagram while it grows. All do nothing by default.
class DiagramObserver {
 public:
  virtual ~DiagramObserver() = default;
  virtual void on_branch_start(const Branch&) {}
  virtual void on_way_back(const Point&) {}  ///< from inside a branch to its beginning; not yet reported
  virtual void on_point(const Branch&, const Point&) {}          ///< every point, special ones included
  virtual void on_special_point(const Branch&, const Point&) {}  ///< new special points, after on_point
  virtual void on_branch_end(const Branch&) {}
  virtual bool should_stop() { return false; }  ///< polled after each step
  /// After each step, before a stop ends the branch in progress: all that was found has been reported, and
  /// resume_diagram would go on from this state. It shares the walker's live problem: store it now or never.
  virtual void on_rest(const DiagramState&) {}
};

/// The first branch, then, breadth first, the arms of every branch point found.
///
/// A branch that meets a special point of another branch (same kind, parameter and fingerprint) has joined
/// it: it ends there, and the arm it came along is not walked again from the other side. A branch that goes
/// through itself meets its own branch point again, and goes on; the arms it is itself are not walked.
Diagram trace_diagram(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
                      const Options& options, const DiagramOptions& diagram_options,
                      DiagramObserver& observer);

/// Goes on where `state` was handed out; with the same options the diagram ends like one never left. Branches
/// and points reported before are not reported again.
Diagram resume_diagram(DiagramState state, const Options& options, const DiagramOptions& diagram_options,
                       DiagramObserver& observer);

}  // namespace continuation
