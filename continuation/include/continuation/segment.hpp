#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "continuation/corrector.hpp"
#include "continuation/small_eigenvalues.hpp"
#include "continuation/tangent.hpp"

namespace continuation {

/// A solution near the base of a segment, at path length s along the base's tangent.
struct Sample {
  double s = 0.0;
  Iterate it;                             ///< state, sum of increments since the base, parameters
  Tangent tangent;                        ///< unit, oriented like the base's; empty until completed
  bool complete = false;                  ///< tangent, index and determinant are known
  int index = -1;                         ///< Problem::index; -1: unknown
  int complex_index = 0;                  ///< Problem::complex_index
  int breaking_index = -1;                ///< Problem::breaking_index; -1: unknown
  int determinant = 0;                    ///< sign of det [J F_p; base tangent]; 0: unknown
  std::optional<SmallEigenvalues> small;  ///< where the index is unknown
  std::vector<EventFunction> events;      ///< empty unless asked for
  CorrectorReport report;
};

/// How large a correction was: its length in the metric, and the varied parameter's share.
struct Correction {
  double length = 0.0, parameter = 0.0;
};

/// The piece of a branch that leaves a base point (x, p) with unit tangent t, solved at any path length s by
///
///     F(x, p) = 0,      dual(t_x)·u + t_p Δp / scale² = s,
///
/// with u the sum of the increments since the base (states are only ever changed through Problem::retract).
/// Samples are kept: each new one starts from the secant through the two nearest, so that locating a point
/// takes few corrections.
class Segment {
 public:
  /// The options are copied. @param tangent  unit length in the metric
  Segment(std::shared_ptr<Problem> problem, const Options& options, Vector x, Vector p, Tangent tangent);

  /// The derivative of the tangent along the branch, as far as it is known: the first sample starts on the parabola.
  void bend(Tangent curvature) { curvature_ = std::move(curvature); }

  /// The solution at s; null (see failure()) if Newton's method fails. The pointer lives as long as the
  /// segment.
  Sample* at(double s, bool complete);

  /// The completed solution at s = 0 where the base itself does not solve F = 0; null if Newton's method fails.
  const Sample* corrected();

  /// The solution with the varied parameter fixed to exactly `value`, which lies between those of the two
  /// samples.
  Sample* at_parameter(double value, const Sample& lo, const Sample& hi, bool complete);

  /// Adds tangent, index and determinant: one factorisation, none if the corrector's last one was made there.
  /// @throws std::runtime_error, std::domain_error as the problem does
  void complete(Sample& sample);
  /// The same; false, with the reason in failure(), where it throws.
  bool completed(Sample& sample);

  /// Adds the event values.
  void add_events(Sample& sample);

  /// One more correction, on a fresh factorisation. @throws std::runtime_error, std::domain_error as the problem does
  Correction sharpen(Sample& sample);

  /// The completed sample nearest to s on one side (±1), at least `beyond` away; null if there is none.
  const Sample* complete_beside(double s, double beyond, int side) const;

  /// Path length of the farthest sample.
  double reach() const;

  Sample& base() { return samples_.front(); }
  const Sample& base() const { return samples_.front(); }
  const Tangent& tangent() const { return tangent_; }
  /// Path length along the base's tangent of an increment (u, dp).
  double path_length(const Vector& u, double dp) const {
    return keller_.c.col(0).dot(u) + keller_.d(0, 0) * dp;
  }
  double parameter(const Sample& sample) const { return sample.it.p[options_.parameter]; }
  const std::string& failure() const { return failure_; }
  const std::shared_ptr<Problem>& problem() const { return problem_; }
  const Options& options() const { return options_; }

 private:
  bool settled(Sample& sample);  ///< Problem::settle; false, with the reason in failure(), where it throws
  bool tried(const std::function<void()>& step);
  Iterate guess(double s) const;
  Sample* finish(const Borders& borders, Iterate it, bool complete);

  std::shared_ptr<Problem> problem_;
  Options options_;
  Tangent tangent_, curvature_;  // empty: unknown
  Borders keller_;
  std::deque<Sample> samples_;  // front: the base
  std::string failure_;
};

}  // namespace continuation
