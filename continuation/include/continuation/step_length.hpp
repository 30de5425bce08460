#pragma once

#include "continuation/options.hpp"

namespace continuation {

/// Step length along a branch, from what Newton's method did in the last step.
///
/// After an accepted step with N corrections and first contraction θ = |δ₁|/|δ₀| (which grows like ds²),
///
///     ds ← ds · clamp( min( √(θ*/θ), 2^((N* − N)/2) ), ½, 2 )
///
/// limited to [step_min, step_max]; θ* = target_contraction, N* = target_newton. The first accepted step
/// after a rejection does not grow, so that accepted and rejected steps do not alternate. A rejection halves
/// ds.
class StepLength {
 public:
  explicit StepLength(const Options& options);
  /// Goes on from where another one was.
  StepLength(const Options& options, double current, double usual, bool after_rejection);

  double current() const { return step_; }
  bool after_rejection() const { return after_rejection_; }

  /// The step before a run of rejections shortened it, until it has recovered: what suits the branch beyond an event
  /// that was hard to reach.
  double usual() const { return usual_ > step_ ? usual_ : step_; }

  /// @param iterations   N, corrections of the accepted step
  /// @param contraction  θ of the accepted step; 0 when there were fewer than two corrections
  void accepted(int iterations, double contraction);

  /// @return false when the halved step is below step_min; the step then stays as it was.
  bool rejected();

  /// Starts again from a given length (limited to the allowed range).
  void reset(double step);

 private:
  void set(double step);

  double step_, step_min_, step_max_, target_contraction_;
  double usual_ = 0.0;
  int target_newton_;
  bool after_rejection_ = false;
};

}  // namespace continuation
