#pragma once

namespace windlass::pull {

/// [d]₊ = max(0, d) with its kink rounded over ±width, once continuously differentiable: Newton's method stumbles over
/// kinks that many places pass at once.
struct Rounded {
  double value = 0.0, slope = 0.0;
};
inline Rounded rounded(double d, double width) {
  if (d <= -width) return {};
  if (d >= width) return {d, 1.0};
  const double x = (d + width) / (2.0 * width);
  return {width * x * x, x};
}

}  // namespace windlass::pull
