#include "continuation/bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace continuation {

namespace {

// Where f does not exist at x inside [b, c]: moves both ends as close to x as f allows.
void close_in(double x, double& b, double& fb, double& c, double& fc,
              const std::function<std::optional<double>(double)>& f) {
  const auto approach = [&](double& end, double& value) {
    for (const double part : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
      const double near = x + part * (end - x);
      const std::optional<double> there = f(near);
      if (!there || !std::isfinite(*there)) continue;
      if (*there != 0.0 && (*there > 0.0) == (value > 0.0)) end = near, value = *there;
      return;
    }
  };
  approach(b, fb);
  approach(c, fc);
}

/// What rounding of f does to its zero: seen where f between two ends is larger than at the one of its sign, and both are as small.
class Rounding {
 public:
  Rounding(double lo, double f_lo, double hi, double f_hi)
      : values_{{lo, f_lo}, {hi, f_hi}}, first_(hi - lo) {}

  void add(double x, double f) { values_.emplace_back(x, f); }

  /// @param f_end    at the end of the bracket where f has the sign of now
  /// @param f_other  at its other end
  /// @returns how far the zero may have moved; nullopt: f is smooth as far as can be told
  std::optional<double> seen(double x, double f, double f_end, double f_other, double width) const {
    // In a wide bracket f may turn.
    constexpr double narrow = 1e-4, several = 3.0, clear = 30.0;
    const auto clearly = [&](double value) { return std::abs(value) >= clear * std::abs(f); };
    if (!(width < narrow * first_) || std::abs(f) <= std::abs(f_end) || clearly(f_other)) return std::nullopt;
    double nearest = HUGE_VAL, slope = 0.0;
    for (const auto& [at, value] : values_)
      if (clearly(value) && std::abs(at - x) < nearest)
        nearest = std::abs(at - x), slope = std::abs(value) / nearest;
    if (slope == 0.0) return std::nullopt;
    return several * std::abs(f) / slope;
  }

 private:
  std::vector<std::pair<double, double>> values_;
  double first_;
};

}  // namespace

// Brent 1973, Algorithms for Minimization without Derivatives, ch. 4 (zeroin): [b, c] holds the zero, |f(b)|
// <= |f(c)|.
Bracket find_zero(double lo, double f_lo, double hi, double f_hi, double tolerance,
                  const std::function<std::optional<double>(double)>& f) {
  double a = lo, fa = f_lo, b = hi, fb = f_hi, c = a, fc = fa;
  double d = b - a, e = d;
  Bracket bracket;
  Rounding rounding(lo, f_lo, hi, f_hi);
  for (int k = 0; k < 100; ++k) {
    if ((fb > 0.0) == (fc > 0.0) && fb != 0.0 && fc != 0.0) {
      c = a;
      fc = fa;
      d = e = b - a;
    }
    if (std::abs(fc) < std::abs(fb)) {
      a = b;
      b = c;
      c = a;
      fa = fb;
      fb = fc;
      fc = fa;
    }
    const double reach = 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b) + 0.5 * tolerance;
    const double half = 0.5 * (c - b);
    if (std::abs(half) <= reach || fb == 0.0) {
      bracket.converged = true;
      break;
    }
    if (std::abs(e) < reach || std::abs(fa) <= std::abs(fb)) {
      d = e = half;
    } else {
      double p, q;
      const double s = fb / fa;
      if (a == c) {
        p = 2.0 * half * s;
        q = 1.0 - s;
      } else {
        const double r = fb / fc, t = fa / fc;
        p = s * (2.0 * half * t * (t - r) - (b - a) * (r - 1.0));
        q = (t - 1.0) * (r - 1.0) * (s - 1.0);
      }
      if (p > 0.0) {
        q = -q;
      } else {
        p = -p;
      }
      if (2.0 * p < std::min(3.0 * half * q - std::abs(reach * q), std::abs(e * q))) {
        e = d;
        d = p / q;
      } else {
        d = e = half;
      }
    }
    const double next = b + (std::abs(d) > reach ? d : std::copysign(reach, half));
    const std::optional<double> value = f(next);
    if (!value || !std::isfinite(*value)) {
      close_in(next, b, fb, c, fc, f);
      break;
    }
    const bool as_at_b = (*value > 0.0) == (fb > 0.0);
    rounding.add(next, *value);
    if (const auto noise =
            rounding.seen(next, *value, as_at_b ? fb : fc, as_at_b ? fc : fb, std::abs(c - b))) {
      bracket.noise = *noise;
      bracket.converged = true;
      break;
    }
    a = b;
    fa = fb;
    b = next;
    fb = *value;
  }
  bracket.best = b;
  bracket.lo = std::min(b, fb == 0.0 ? b : c);
  bracket.hi = std::max(b, fb == 0.0 ? b : c);
  return bracket;
}

}  // namespace continuation
