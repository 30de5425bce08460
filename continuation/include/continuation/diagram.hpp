#pragma once

#include <string>
#include <vector>

#include "continuation/branch_switch.hpp"
#include "continuation/walker.hpp"

namespace continuation {

struct DiagramOptions {
  bool both_ways = false;  ///< the first branch is walked in both directions from the start
  int max_branches = 50;   ///< branches in all
  int max_depth = 3;       ///< branch points between the first branch and the last arms
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
  std::vector<Tangent> arrivals;      ///< from a joining branch, pointing back along it
  std::vector<Point> arrival_points;  ///< and the joining branch's own solution there
};

struct Diagram {
  std::vector<Branch> branches;
  std::vector<SpecialPoint> specials;
  std::vector<std::string>
      lost;              ///< what failed: lost branches, arms that could not be started, limits reached
  bool stopped = false;  ///< by should_stop
};

/// Receives the diagram while it grows. All do nothing by default.
class DiagramObserver {
 public:
  virtual ~DiagramObserver() = default;
  virtual void on_branch_start(const Branch&) {}
  virtual void on_point(const Branch&, const Point&) {}          ///< every point, special ones included
  virtual void on_special_point(const Branch&, const Point&) {}  ///< new special points, after on_point
  virtual void on_branch_end(const Branch&) {}
  virtual bool should_stop() { return false; }  ///< polled after each point
};

/// The first branch, then, breadth first, the arms of every branch point found.
///
/// A branch that meets a special point of another branch (same kind, parameter and fingerprint) has joined
/// it: it ends there, and the arm it came along is not walked again from the other side.
Diagram trace_diagram(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
                      const Options& options, const DiagramOptions& diagram_options,
                      DiagramObserver& observer);

}  // namespace continuation
