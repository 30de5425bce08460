#include "windlass/discrete_rod/spline_rod.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::discrete_rod {

using Eigen::Index;

Weights cubic_weights(double t, int order) {
  const double u = 1.0 - t;
  if (order == 0)
    return Weights(u * u * u, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * u * u * u - 6.0 * u * u + 4.0,
                   t * t * t) /
           6.0;
  if (order == 1) return Weights(-u * u, 3.0 * t * t - 4.0 * t, -3.0 * u * u + 4.0 * u, t * t) / 2.0;
  return Weights(u, 3.0 * t - 2.0, 1.0 - 3.0 * t, t);
}

SplineRod::SplineRod(double half_length, double fine_length, double h) : knots_{0.0} {
  constexpr double growth = 1.5, most = 10.0;  // e-folding length of the grading [ρ], and its end
  double s = 0.0;
  while (s < half_length) {
    const double factor = std::min(most, std::exp(std::max(0.0, s - fine_length) / growth));
    lengths_.push_back(h * factor);
    s += h * factor;
  }
  for (double& length : lengths_) {
    length *= half_length / s;
    knots_.push_back(knots_.back() + length);
  }
}

SplineRod::Place SplineRod::place(int j, int c) {
  if (j == 0) return {c == 1 ? 0 : -1, 1.0};
  return {3 * (std::abs(j) - 1) + 1 + c, j < 0 && c != 1 ? -1.0 : 1.0};
}

SplineRod::Controls SplineRod::controls(const Vector& x, int element) const {
  Controls out;
  for (int k = 0; k < 4; ++k)
    for (int c = 0; c < 3; ++c) {
      const auto [index, sign] = place(element - 1 + k, c);
      out(c, k) = index < 0 ? 0.0 : sign * x(index);
    }
  return out;
}

SplineRod::Vector SplineRod::through(const std::vector<Point>& at_knots) const {
  const int last = elements();
  const auto point = [&](int j) -> Point {
    if (j > last) return 2.0 * at_knots[last] - at_knots[last - 1];  // a free end is straight
    const Point& p = at_knots[std::abs(j)];
    return j < 0 ? Point(-p(0), p(1), -p(2)) : p;
  };
  Vector x(size());
  for (int j = 0; j <= last + 1; ++j) {
    // Knot values are (c_{j−1} + 4 c_j + c_{j+1})/6; this is its inverse but for fourth differences.
    Point c = point(j);
    if (j < last) c -= (point(j - 1) - 2.0 * point(j) + point(j + 1)) / 6.0;
    for (int k = 0; k < 3; ++k)
      if (const auto [index, sign] = place(j, k); index >= 0) x(index) = c(k);
  }
  return x;
}

}  // namespace windlass::discrete_rod
