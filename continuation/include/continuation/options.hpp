#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace continuation {

/// The units in which lengths along a branch are measured:
/// |(dx, dp)|² = inner(dx, dx)/state² + (dp/parameter)².
struct Scales {
  double parameter = 1.0, state = 1.0;
};

/// A number of the caller's, recorded at every point; where it changes sign a point of type `function` is
/// located.
struct UserFunction {
  std::string name;
  std::function<double(const Eigen::VectorXd& x, const Eigen::VectorXd& p)> value;
  bool stop = false;  ///< the branch ends at the first zero
};

/// How a branch is walked. Lengths are path lengths in the metric of Scales: step lengths and tolerances are
/// pure numbers once the scales are the sizes of the state, the parameter and the residual.
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
  double state_scale = 1.0;      ///< x's unit in the metric, > 0
  double residual_scale = 1.0;   ///< F's unit, > 0: of its terms where x and p have the size of their units
  int max_points = 2000;         ///< accepted points, special ones not counted
  double max_angle = 1.0;        ///< [rad] largest turn of the tangent in one step, in (0, π/2)

  double newton_tolerance =
      1e-10;  ///< on the increment, in the metric; times max(1, rms x) once it stagnates
  double residual_tolerance = 1e-8;  ///< on max |F| in its unit, checked before the last increment is added
  int max_newton = 8;                ///< corrections allowed in one solve
  int target_newton = 4;             ///< corrections (chord ones included) the step length aims at
  double target_contraction = 0.1;   ///< |δ₁|/|δ₀| the step length aims at, in (0, 1)

  double location_tolerance =
      1e-10;  ///< of special points, in path length and in p; times max(1, |p|), p in its unit
  double event_zero = 1e-10;  ///< event values smaller than this have no sign

  bool detect_events = true;
  bool detect_folds = true;
  bool detect_branch_points = true;  ///< needs the index (or determinant sign): one factorisation a point
  bool detect_closed = true;
  bool adapt = true;

  std::vector<UserFunction> functions;

  Scales scales() const { return {parameter_scale, state_scale}; }

  /// @throws std::invalid_argument naming the violated bound and the value.
  void validate() const;
};

}  // namespace continuation
