#pragma once

#include <Eigen/Core>
#include <limits>

namespace continuation {

/// How a branch is walked. Lengths are path lengths in the metric  |(dx, dp)|² = inner(dx, dx) +
/// (dp/parameter_scale)².
struct Options {
  Eigen::Index parameter = 0;                                ///< which entry of p varies
  double target = std::numeric_limits<double>::quiet_NaN();  ///< stop value of p, hit exactly; NaN: none
  double lower = -std::numeric_limits<double>::infinity();   ///< the branch also stops, exactly, on leaving
  double upper = std::numeric_limits<double>::infinity();    ///< [lower, upper]
  int direction = 1;                                         ///< sign of dp at the start, ±1

  double step = 0.05;            ///< first step
  double step_min = 1e-7;        ///< a step cut below this loses the branch
  double step_max = 0.5;         ///< largest step
  double parameter_scale = 1.0;  ///< p's unit in the metric, > 0
  int max_points = 2000;         ///< accepted points, special ones not counted
  double max_angle = 1.0;        ///< [rad] largest turn of the tangent in one step, in (0, π/2)

  double newton_tolerance =
      1e-10;  ///< on the increment, in the metric; times max(1, rms x) once it stagnates
  double residual_tolerance = 1e-8;  ///< on max |F|, checked before the last increment is added
  int max_newton = 8;                ///< corrections allowed in one solve
  int target_newton = 4;             ///< corrections (chord ones included) the step length aims at
  double target_contraction = 0.1;   ///< |δ₁|/|δ₀| the step length aims at, in (0, 1)

  double location_tolerance = 1e-10;  ///< of special points, in path length and in p, relative to max(1, |p|)
  double event_zero = 1e-10;          ///< event values smaller than this have no sign

  bool detect_events = true;
  bool detect_folds = true;
  bool detect_branch_points = true;  ///< needs the index (or determinant sign): one factorisation a point
  bool detect_closed = true;
  bool adapt = true;

  /// @throws std::invalid_argument naming the violated bound and the value.
  void validate() const;
};

}  // namespace continuation
