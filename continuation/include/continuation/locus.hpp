#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "continuation/locus_system.hpp"
#include "continuation/point.hpp"
#include "continuation/step_length.hpp"

namespace continuation {

/// How a locus is walked. `options` gives λ (parameter), its bounds (lower, upper), scale, and all step,
/// tolerance and max_points settings; its target is ignored. direction is the initial sign of dμ.
struct LocusOptions {
  Options options;
  Eigen::Index second = 1;  ///< index of μ in p
  double second_lower = -std::numeric_limits<double>::infinity();
  double second_upper = std::numeric_limits<double>::infinity();
  double second_scale = 1.0;  ///< μ's unit in the metric
  bool pass_events = true;    ///< go on through Problem::transition where the special point exists beyond it

  /// @throws std::invalid_argument
  void validate() const;
};

struct LocusPoint {
  enum class Type { start, regular, degenerate, event, end };
  std::shared_ptr<Problem> problem;  ///< live; a clone at degenerate points and events
  Vector x, p;
  Vector tangent;  ///< (dλ, dμ, dα) or (dλ, dμ), unit in the scaled metric
  NullVectors null;
  Type type = Type::regular;
  double ds = 0.0;
  int newton_iterations = 0;
  std::string event;          ///< name, at an event of another function than the one followed
  std::string before, after;  ///< of its Transition
  std::string note;           ///< at a degenerate point: "cusp", ...
  double precision = 0.0;     ///< the last Newton increment in (λ, μ)
};

/// The curve of a special point in two parameters.
///
/// Keller's pseudo-arclength method on LocusSystem. Degenerate points (cusps of fold loci, points where a
/// branch point's two branches become tangent) are regular points of the curve and are located and yielded.
/// The walk ends, with a reason, where a parameter leaves its bounds (hit exactly), where another event
/// happens beyond which the special point is not found, where a crossing comes apart, at the start (closed),
/// or where steps fail down to step_min (lost).
class LocusWalker {
 public:
  /// From a located special point of a Walker (fold, branch_point, event), corrected with μ fixed.
  /// @throws std::invalid_argument for options out of bounds or a point of another type
  LocusWalker(const Point& special, const LocusOptions& options);

  std::optional<LocusPoint> step();
  void stop(const std::string& reason) { end_ = End{End::Kind::stopped, reason}; }
  const End& end() const { return end_; }
  LocusKind kind() const { return kind_; }

 private:
  struct Solution {
    Vector z;
    int iterations = 0;
    double contraction = 0.0, precision = 0.0;
  };

  // Bounds and events move the end of a step back from `whole`.
  struct Step {
    Vector base, row;  // arclength equation: row·(z − base) = s
    double ds = 0.0, s_end = 0.0;
    Solution whole, end;  // at ds and at s_end
    End reason;           // to end the walk
    std::string crossed;  // name of the event at the end

    Vector guess(double s) const { return base + (s / ds) * (whole.z - base); }
  };

  void start();
  void advance();
  bool advance_once(std::string& failure);
  std::optional<Step> predict_and_correct(std::string& failure);
  bool shorten_to_bounds(Step& step, std::string& failure);
  const EventFunction* most_negative_event(const Step& step, const std::vector<EventFunction>& at_end) const;
  bool shorten_to_first_event(Step& step, std::string& failure);
  bool is_back_at_start(const Step& step) const;
  bool queue_degenerate_point(const Step& step, const Matrix& jacobian_at_end, std::string& failure);
  void finish_step(const Step& step, LocusPoint point);
  std::optional<Solution> solve_at(const Step& step, double s, const Vector& guess, std::string& failure);
  std::optional<Solution> solve(const Vector& row, double value, Vector guess, Matrix jacobian,
                                std::string& failure);
  bool rebase(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
              std::optional<NullVectors> null, const Vector& orientation, std::string& failure);
  bool settle(const Solution& solution, const Matrix& jacobian, LocusPoint& point, std::string& failure);
  void adapt();
  void pass(LocusPoint point, std::size_t which, const std::string& name);
  double degeneracy(const Matrix& jacobian) const;
  LocusPoint make(LocusPoint::Type type, const Solution& solution) const;

  LocusOptions options_;
  LocusKind kind_;
  int multiplicity_ = 1;
  std::string event_;
  std::shared_ptr<Problem> problem_;
  Vector x_, p_;
  std::unique_ptr<LocusSystem> system_;
  Vector z_;  // where the locus is, in the system's unknowns
  Matrix jacobian_;
  Vector tangent_, scale_;
  StepLength step_length_;
  std::vector<EventFunction> events_;
  std::vector<LocusPoint> queue_;
  End end_, pending_end_;
  bool started_ = false, adapt_pending_ = false;
  int points_ = 0, transitions_in_place_ = 0;
  Vector start_p_, start_tangent_;
};

}  // namespace continuation
