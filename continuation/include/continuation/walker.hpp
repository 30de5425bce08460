#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "continuation/detect.hpp"
#include "continuation/options.hpp"
#include "continuation/point.hpp"
#include "continuation/segment.hpp"
#include "continuation/step_length.hpp"

namespace continuation {

/// Walks one branch by pseudo-arclength continuation, a point a call.
///
/// A step predicts along the unit tangent, corrects with Keller's constraint, then looks between the two
/// points for folds (dp/ds changes sign), events (an event function changes sign) and branch points (the
/// index changes, folds accounted for), and yields what it found in the order of the branch. A failed step
/// leaves the state untouched and halves ds.
///
/// ```
/// Walker walker(problem, x, p, options);
/// while (auto point = walker.step()) use(*point);
/// if (walker.end().lost()) report(walker.end().reason);
/// ```
class Walker {
 public:
  /// From a guess at p, corrected there with p fixed; leaves in the direction options.direction of the
  /// parameter.
  /// @throws std::invalid_argument for options out of bounds or a parameter that p does not have
  Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, const Options& options);

  /// From a stored point, in the direction of a tangent (shape n; need not be exact).
  Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, Tangent tangent, const Options& options);

  /// The next point; nullopt when the branch is over, see end(). The first is the start.
  std::optional<Point> step();

  /// Ends the walk after what has been yielded (Ctrl-C).
  void stop(const std::string& reason);

  const End& end() const { return end_; }
  const std::shared_ptr<Problem>& problem() const { return problem_; }
  const Vector& x() const { return x_; }
  const Vector& p() const { return p_; }
  const Tangent& tangent() const { return tangent_; }
  int index() const { return index_; }
  double path_length() const { return path_length_; }
  const Options& options() const { return options_; }

 private:
  void start();
  void advance();
  bool advance_once(std::string& failure);
  bool limit(Segment& segment, Sample*& end, Located* fold, End& reason);
  Sample* close(Segment& segment, Sample& end, Located* fold);
  void remember_start();
  bool event_at_edge();
  void settle(Segment& segment, Sample& sample);
  Point special(Segment& segment, const Located& located);
  void adapt();

  // walker_transition.cpp
  void pass(Point event, std::size_t which, const std::string& name, int direction);
  bool enter(const Transition& transition, int direction, const std::string& passed, std::string& failure);
  bool valid_direction(const std::shared_ptr<Problem>& problem, const Vector& x, const Vector& p,
                       const Tangent& tangent, const std::string& passed);

  double& parameter(Vector& p) const { return p[options_.parameter]; }
  double parameter(const Vector& p) const { return p[options_.parameter]; }
  void lose(const std::string& reason) { end_ = End{End::Kind::lost, reason}; }

  std::shared_ptr<Problem> problem_;
  Vector x_, p_;
  Tangent tangent_, previous_tangent_;
  Options options_;
  StepLength step_length_;
  int index_ = -1, determinant_ = 0;
  std::vector<EventFunction> events_, previous_events_;
  double last_ds_ = 0.0;
  EventSigns signs_;
  double path_length_ = 0.0;
  int points_ = 0;
  int events_in_place_ = 0;  // consecutive events without progress
  bool started_ = false, has_tangent_ = false, adapt_pending_ = false;
  bool mesh_changed_ = false;  // since remember_start: states no longer compare entry by entry
  int folds_ = 0, branch_points_ = 0, event_points_ = 0;

  Vector start_x_;  // to see a closed curve
  Vector start_fingerprint_;
  double start_parameter_ = 0.0, start_slope_ = 0.0;

  std::deque<Point> queue_;
  End end_, pending_end_;
};

}  // namespace continuation
