#pragma once

#include <functional>
#include <optional>

namespace continuation {

/// An interval that holds a zero, and the best estimate in it.
struct Bracket {
  double lo = 0.0, hi = 0.0;  ///< the function has opposite signs at the two ends
  double best = 0.0;          ///< the end with the smaller value
  bool converged = false;     ///< hi − lo reached the tolerance, or f is its own rounding there
  double noise = 0.0;         ///< how far rounding of f may have moved the zero, where it was seen
};

/// Zero of a continuous f with f(lo) f(hi) <= 0 by Brent's method, which ends with both ends of the bracket
/// within 2·tolerance of each other, or where values between them are no smaller than at them: there f is its own
/// rounding. f may decline (nullopt); the bracket reached so far is then returned.
Bracket find_zero(double lo, double f_lo, double hi, double f_hi, double tolerance,
                  const std::function<std::optional<double>(double)>& f);

}  // namespace continuation
