#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "continuation/options.hpp"
#include "continuation/segment.hpp"
#include "continuation/step_length.hpp"
#include "continuation/walk_state.hpp"

namespace continuation {

/// Walks one branch by pseudo-arclength continuation, a point a call.
///
/// A step predicts along the unit tangent, corrects with Keller's constraint, then looks between the two
/// points for folds (dp/ds changes sign and the index by an odd number), events (an event function changes
/// sign) and branch points (the index changes), and yields what it found in the order of the branch. A failed
/// step leaves the state untouched and halves ds; so does one that has left its branch, which shows in a
/// corrector that leads away from the tangents, or in an index that changes where no branch point is.
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

  /// Goes on from where another walker was.
  Walker(WalkState state, const Options& options);

  /// The next point; nullopt when the branch is over, see end(). The first is the start.
  std::optional<Point> step();

  /// Ends the walk after what has been yielded (Ctrl-C).
  void stop(const std::string& reason);

  /// Everything found by the last step has been handed out: a walk can be left here and gone on with later.
  bool at_rest() const { return queue_.empty(); }
  /// What a walker that goes on from here needs; shares the problem. Only at rest.
  WalkState state() const;

  const End& end() const { return state_.end; }
  const std::shared_ptr<Problem>& problem() const { return state_.problem; }
  const Vector& x() const { return state_.x; }
  const Vector& p() const { return state_.p; }
  const Tangent& tangent() const { return state_.tangent; }
  int index() const { return state_.index; }
  double path_length() const { return state_.path_length; }
  const Options& options() const { return options_; }

 private:
  void advance();
  // walker_start.cpp
  void start();
  bool start_regular(bool anyhow, std::string& failure);
  bool start_beside_event(bool singular);
  bool start_singular();
  bool start_at_given();
  bool start_at_branch_point();
  bool start_at_fold();
  bool start_at_double_point();
  void queue_branch_point(BranchPoint point);
  void start_at(const Vector& x, const Vector& p, const Tangent& tangent);
  // walker_step.cpp
  bool advance_once(std::string& failure);
  bool leaves_branch(const Segment& segment, const Sample& end, std::string& failure) const;
  std::optional<Tangent> curvature(double ds) const;
  bool long_step(double ds) const;
  bool find_specials(Segment& segment, const Sample& end, const Located* turn, bool at_event,
                     std::vector<Located>& specials, std::string& failure);
  void accept(Segment& segment, Sample& end, const CorrectorReport& report, const End& reason);
  // walker_stops.cpp
  bool shorten(Segment& segment, Sample*& end, Located* turn, End& reason, std::optional<Located>& event,
               std::string& failure);
  bool find_functions(Segment& segment, Sample*& end, End& reason, std::optional<Located>& event,
                      std::vector<Located>& found, std::string& failure);
  bool limit(Segment& segment, Sample*& end, Located* fold, End& reason);
  Sample* close(Segment& segment, Sample& end, Located* fold);
  void remember_start();
  bool event_at_edge();
  void settle(Segment& segment, Sample& sample);
  Point special(Segment& segment, const Located& located);
  /// The walker's own state as a point.
  Point here(PointType type) const;
  std::vector<double> function_values(const Vector& x, const Vector& p) const;
  void adapt();
  void settle_event(Point& event, const std::string& name);

  // walker_transition.cpp
  void say_what_follows(Point& event) const;
  void note(Point event, const EventFunction& function, const Transition& transition);
  /// @param met  p[parameter] up to which stop values have been looked for: on the mesh before the event's own
  void pass(Point event, std::size_t which, const std::string& name, int direction, double met);
  static Sample* solution_at(Segment& segment, double value, const Sample& lo, const Sample& hi);
  void stop_before_entry(double met, double event, double precision);
  bool walk_back_to(double stop);
  /// What a function may be at the point of its event, by rounding.
  double rounded_zero() const { return 1e4 * options_.event_zero; }
  void forget_rounded_signs(bool negative);
  bool leads_back(Problem& next, const Iterate& it, const Tangent& way) const;
  bool enter(const Transition& transition, int direction, const std::string& passed, std::string& failure);
  /// A way along the branch of another problem, and the part of a step over which it holds; 0: it does not.
  struct Way {
    int sign;
    Tangent tangent;
    double valid;
  };
  std::array<Way, 2> ways_along(const Transition& transition, const Iterate& it, int direction,
                                const std::string& passed);
  double valid_over(const std::shared_ptr<Problem>& problem, const Vector& x, const Vector& p,
                    const Tangent& tangent, const std::string& passed);
  void enter_at(Segment& segment, Sample& sample);
  // walker_leap.cpp
  bool leap(Point& event);
  std::optional<Transition> leap_to(double length, int& direction);

  double& parameter(Vector& p) const { return p[options_.parameter]; }
  double parameter(const Vector& p) const { return p[options_.parameter]; }
  void lose(const std::string& reason) { state_.end = End{End::Kind::lost, reason}; }

  WalkState state_;  // its step and after_rejection are kept by step_length_
  Options options_;
  StepLength step_length_;
  std::deque<Point> queue_;
  End pending_end_;
};

}  // namespace continuation
