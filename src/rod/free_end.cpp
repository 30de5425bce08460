#include "free_end.hpp"

#include <algorithm>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <cmath>

namespace windlass::rod {

namespace {

using Plain = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// u with its derivatives: ρ ∂u/∂ρ and ∂u/∂q. By ∂R_F/∂x = −R_D(y, z, x)/6 (DLMF 19.18.1).
struct Time {
  double u, by_log_ratio, by_q;
};

Time time_with_slopes(const EndRatio& at, double q) {
  const double ratio = at.rho, below = 1.0 - ratio * q, x = ratio * (1.0 - q) / below;
  const double root = std::sqrt(at.deficit / below);  // √(1 − x)
  const double rf = boost::math::ellint_rf(x, ratio, 1.0, Plain());
  const double rf_x = -boost::math::ellint_rd(ratio, 1.0, x, Plain()) / 6.0;
  const double rf_y = -boost::math::ellint_rd(x, 1.0, ratio, Plain()) / 6.0;
  const double by_x = root * rf_x - 0.5 * rf / root;
  return {root * rf, x / below * by_x + root * ratio * rf_y, -ratio * at.deficit / (below * below) * by_x};
}

}  // namespace

EndRatio EndRatio::of_log(double log_rho) { return {std::exp(log_rho), -std::expm1(log_rho)}; }

EndRatio EndRatio::of_growth(double v) { return {std::pow(std::cosh(v), -2), std::pow(std::tanh(v), 2)}; }

double EndRatio::growth() const { return std::asinh(std::sqrt(deficit / rho)); }

Elapsed elapsed(const EndRatio& ratio, double q) {
  const Time time = time_with_slopes(ratio, q);
  return {time.u, time.by_log_ratio};
}

double time_from_end(const EndRatio& ratio, double q) {
  const double below = 1.0 - ratio.rho * q, x = ratio.rho * (1.0 - q) / below;
  return std::sqrt(ratio.deficit / below) * boost::math::ellint_rf(x, ratio.rho, 1.0, Plain());
}

FreeEnd free_end(double u, double q) {
  if (u > far_end) return {};
  // Newton in log ρ, in which u is nearly linear: from the end of a straight tail, cosh⁻²u, and the separatrix's angle.
  const double quarter = 0.5 * (1.0 + std::sqrt(1.0 - q));  // cos²(ψ/4)
  const double straight = -2.0 * std::log(std::cosh(u)), half = std::log1p(-0.5 * std::pow(std::tanh(u), 2));
  double log_ratio = std::min(straight - 2.0 * std::log(quarter), half);
  Time at{};
  for (int k = 0; k < 40; ++k) {
    at = time_with_slopes(EndRatio::of_log(log_ratio), q);
    const double step = (u - at.u) / at.by_log_ratio;
    log_ratio = log_ratio + step < 0.0 ? log_ratio + step : 0.5 * log_ratio;
    // The slopes are those before the step, and change by step/log² or so: short tails have a small log ρ.
    if (std::abs(step) < 1e-12 * std::abs(log_ratio)) break;
  }
  const EndRatio ratio = EndRatio::of_log(log_ratio);
  return {ratio, at.by_log_ratio, -at.by_q * ratio.rho / at.by_log_ratio, ratio.rho / at.by_log_ratio};
}

double bending(const EndRatio& ratio, double slope, double q, double u) {
  constexpr double close =
      0.05;  // the series' next term is u⁹ there, 1e-16, and the formula loses 1/u² of its digits
  if (u < close && ratio.rho > 0.0) {
    // ψ'' = sin ψ from ψ_e at rest, in powers of u: ¼ ∫ ψ'² du.
    const double end = ratio.rho * q, c = 1.0 - 2.0 * end, s2 = 4.0 * end * (1.0 - end), u2 = u * u;
    const double third = (c * c / 36.0 + (c * c - 3.0 * s2) / 60.0) / 28.0;
    return s2 * u * u2 * (1.0 / 12.0 + u2 * (c / 60.0 + u2 * third));
  }
  // ∫ (ψ'/2)² du = E(u) − k'² u − k² sn cd of the modulus k² = 1 − ρq, and that is the derivative of u by the modulus.
  return -2.0 * (1.0 - ratio.rho * q) * slope - std::sqrt((1.0 - q) / ratio.deficit);
}

}  // namespace windlass::rod
