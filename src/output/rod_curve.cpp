#include "windlass/output/rod_curve.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::output {

using Eigen::Index;
using Eigen::Vector3d;
using equilibrium::ArcRecord;

namespace {

Vector3d tangent(const ArcRecord& arc, Index i) {
  return Eigen::Quaterniond(arc.q(0, i), arc.q(1, i), arc.q(2, i), arc.q(3, i))
      .normalized()
      .toRotationMatrix()
      .col(2);
}

/// Slope of p at sample i from the parabola through its neighbours.
double pressure_slope(const ArcRecord& arc, Index i) {
  const Index n = arc.s.size();
  const auto secant = [&](Index k) {
    return (arc.p[k + 1] - arc.p[k]) / std::max(arc.s[k + 1] - arc.s[k], 1e-300);
  };
  if (n < 3) return n == 2 ? secant(0) : 0.0;
  const Index k = std::clamp<Index>(i, 1, n - 2);
  const double left = arc.s[k] - arc.s[k - 1], right = arc.s[k + 1] - arc.s[k],
               total = std::max(left + right, 1e-300);
  const double second = (secant(k) - secant(k - 1)) / total;
  return secant(k - 1) + second * (2.0 * arc.s[i] - arc.s[k - 1] - arc.s[k]);
}

/// Cubic Hermite interpolation at x in [0, 1] over a length h.
template <class Value>
Value hermite(const Value& a, const Value& slope_a, const Value& b, const Value& slope_b, double h,
              double x) {
  return (1 + 2 * x) * (1 - x) * (1 - x) * a + h * x * (1 - x) * (1 - x) * slope_a + x * x * (3 - 2 * x) * b +
         h * x * x * (x - 1) * slope_b;
}

}  // namespace

RodCurve dense_curve(const equilibrium::Solution& solution, double spacing) {
  RodCurve curve;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    const ArcRecord& arc = solution.arcs[k];
    const auto add = [&](double s, const Vector3d& r, double p) {
      curve.s.push_back(s), curve.r.push_back(r), curve.p.push_back(p), curve.arc.push_back(k);
    };
    for (Index i = 0; i + 1 < arc.s.size(); ++i) {
      const double h = arc.s[i + 1] - arc.s[i];
      const int pieces = std::clamp(static_cast<int>(std::ceil(h / spacing)), 1, 40);
      const Vector3d a = arc.r.col(i), b = arc.r.col(i + 1), ta = tangent(arc, i), tb = tangent(arc, i + 1);
      for (int j = 0; j < pieces; ++j) {
        const double x = static_cast<double>(j) / pieces;
        const double p =
            hermite(arc.p[i], pressure_slope(arc, i), arc.p[i + 1], pressure_slope(arc, i + 1), h, x);
        add(arc.s[i] + x * h, hermite(a, ta, b, tb, h, x), p);
      }
    }
    const Index last = arc.s.size() - 1;
    add(arc.s[last], arc.r.col(last), arc.p[last]);
  }
  return curve;
}

std::vector<PointForce> point_forces(const equilibrium::Solution& solution) {
  std::vector<PointForce> forces;
  for (const auto& joint : solution.joints) {
    if (joint.kind != equilibrium::JointKind::touch && joint.kind != equilibrium::JointKind::edge) continue;
    const Vector3d outward = Vector3d(joint.r.x(), joint.r.y(), 0.0).normalized();
    forces.push_back({joint.s, joint.r, outward, joint.force});
  }
  return forces;
}

}  // namespace windlass::output
