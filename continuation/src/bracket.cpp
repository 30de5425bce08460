#include "continuation/bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

}  // namespace

// Brent 1973, Algorithms for Minimization without Derivatives, ch. 4 (zeroin): [b, c] holds the zero, |f(b)|
// <= |f(c)|.
Bracket find_zero(double lo, double f_lo, double hi, double f_hi, double tolerance,
                  const std::function<std::optional<double>(double)>& f) {
  double a = lo, fa = f_lo, b = hi, fb = f_hi, c = a, fc = fa;
  double d = b - a, e = d;
  Bracket bracket;
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
