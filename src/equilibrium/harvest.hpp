#pragma once

#include <continuation/diagram.hpp>
#include <vector>

#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

/// Gathers the states that the branches of a growing diagram have at one value of the parameter.
class Harvest final : public continuation::DiagramObserver {
 public:
  /// @param options  the diagram's
  Harvest(double goal, const continuation::Options& options) : goal_(goal), options_(options) {}

  void on_branch_start(const continuation::Branch&) override { last_.reset(), ++branches_; }
  void on_point(const continuation::Branch& branch, const continuation::Point& point) override;

  std::vector<Started>& states() { return states_; }
  int branches() const { return branches_; }
  int points() const { return points_; }

 private:
  struct Place {
    std::shared_ptr<continuation::Problem> problem;  ///< the walker's own, or a special point's
    Vector x, p;
    continuation::Tangent tangent;
  };
  /// Walks from a state to the goal; false where it is not reached.
  bool reach(const std::shared_ptr<continuation::Problem>& problem, const Place& from, double direction);
  bool between(double a, double b) const { return (a - goal_) * (b - goal_) <= 0.0 && b != a; }

  double goal_;
  continuation::Options options_;
  std::optional<Place> last_;
  std::vector<Started> states_;
  int branches_ = 0, points_ = 0;
};

}  // namespace windlass::equilibrium
