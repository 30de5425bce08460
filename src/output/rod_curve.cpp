#include "windlass/output/rod_curve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace windlass::output {

using Eigen::Index;
using Eigen::Vector3d;
using equilibrium::ArcRecord;

namespace {

/// State at a stored sample with the slopes along s.
struct Sample {
  Eigen::Quaterniond q;
  Vector3d r, n, m, r_slope, n_slope, m_slope;
};

/// @param flat_normal  of a line contact that is not round the cylinder
Sample sample(const ArcRecord& arc, Index i, const std::optional<Vector3d>& flat_normal) {
  Sample at;
  at.q = Eigen::Quaterniond(arc.q(0, i), arc.q(1, i), arc.q(2, i), arc.q(3, i)).normalized();
  at.r = arc.r.col(i), at.n = arc.n.col(i), at.m = arc.m.col(i);
  at.r_slope = at.q.toRotationMatrix().col(2);
  at.n_slope = -arc.p[i] * flat_normal.value_or(Vector3d(at.r.x(), at.r.y(), 0.0).normalized());
  at.m_slope = at.n.cross(at.r_slope);
  return at;
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

namespace {

void add(RodCurve& curve, std::size_t arc, double s, const Sample& at, double p) {
  curve.s.push_back(s), curve.r.push_back(at.r), curve.q.push_back(at.q);
  curve.n.push_back(at.n), curve.m.push_back(at.m), curve.p.push_back(p), curve.arc.push_back(arc);
}

/// Between two samples a distance h apart, x in [0, 1].
Sample between(const Sample& a, const Sample& b, double h, double x) {
  Sample at;
  at.r = hermite(a.r, a.r_slope, b.r, b.r_slope, h, x);
  at.n = hermite(a.n, a.n_slope, b.n, b.n_slope, h, x);
  at.m = hermite(a.m, a.m_slope, b.m, b.m_slope, h, x);
  at.q = a.q.slerp(x, b.q);
  return at;
}

}  // namespace

RodCurve dense_curve(const equilibrium::Solution& solution, double spacing) {
  RodCurve curve;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    const ArcRecord& arc = solution.arcs[k];
    const Index last = arc.s.size() - 1;
    const auto normal = solution.has_cylinder || k >= solution.joints.size()
                            ? std::nullopt
                            : std::optional(solution.joints[k].normal);
    for (Index i = 0; i < last; ++i) {
      const double h = arc.s[i + 1] - arc.s[i];
      const int pieces = std::clamp(static_cast<int>(std::ceil(h / spacing)), 1, 40);
      const Sample a = sample(arc, i, normal), b = sample(arc, i + 1, normal);
      for (int j = 0; j < pieces; ++j) {
        const double x = static_cast<double>(j) / pieces;
        const double p =
            hermite(arc.p[i], pressure_slope(arc, i), arc.p[i + 1], pressure_slope(arc, i + 1), h, x);
        add(curve, k, arc.s[i] + x * h, between(a, b, h, x), p);
      }
    }
    add(curve, k, arc.s[last], sample(arc, last, normal), arc.p[last]);
  }
  return curve;
}

std::vector<PointForce> point_forces(const equilibrium::Solution& solution) {
  std::vector<PointForce> forces;
  for (const auto& joint : solution.joints) {
    if (joint.partner >= 0)
      forces.push_back({joint.s, joint.r, equilibrium::strand_direction(solution, joint), joint.strand_force,
                        solution.joints[static_cast<std::size_t>(joint.partner)].s});
    if (joint.kind != equilibrium::JointKind::touch && joint.kind != equilibrium::JointKind::edge) continue;
    const Vector3d outward =
        solution.has_cylinder ? Vector3d(joint.r.x(), joint.r.y(), 0.0).normalized() : joint.normal;
    forces.push_back({joint.s, joint.r, outward, joint.force});
  }
  return forces;
}

}  // namespace windlass::output
