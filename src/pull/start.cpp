#include "start.hpp"

#include <algorithm>

#include "windlass/output/rod_curve.hpp"

namespace windlass::pull {

using Eigen::Vector3d;

namespace {

/// Cubic between two places of a curve with their unit tangents.
Vector3d between(const output::RodCurve& curve, std::size_t k, double s) {
  const double h = curve.s[k + 1] - curve.s[k];
  if (h <= 0.0) return curve.r[k];
  const double x = (s - curve.s[k]) / h, y = 1.0 - x;
  const Vector3d a = curve.q[k] * Vector3d::UnitZ(), b = curve.q[k + 1] * Vector3d::UnitZ();
  return (1.0 + 2.0 * x) * y * y * curve.r[k] + h * x * y * y * a + x * x * (1.0 + 2.0 * y) * curve.r[k + 1] -
         h * x * x * y * b;
}

}  // namespace

DraggedRod::Vector laid_along(const discrete_rod::OpenSpline& spline, const equilibrium::Solution& state) {
  const output::RodCurve curve = output::dense_curve(state);
  std::vector<Vector3d> points;
  std::size_t k = 0;
  for (int j = 0; j <= spline.elements(); ++j) {
    const double s = std::clamp(spline.knot(j), curve.s.front(), curve.s.back());
    while (k + 2 < curve.s.size() && curve.s[k + 1] <= s) ++k;
    points.push_back(between(curve, k, s));
  }
  return spline.through(points);
}

}  // namespace windlass::pull
