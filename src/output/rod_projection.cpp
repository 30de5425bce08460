#include "windlass/output/rod_projection.hpp"

#include <algorithm>
#include <numbers>

namespace windlass::output {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool Drum::hides(const Vector3d& r, const View& view) const {
  // r + λ towards meets the drum, slightly slimmer so that a rod on its surface does not hide itself
  const double slim = 0.985 * radius;
  const Vector2d d = view.towards.head<2>(), at = r.head<2>();
  const double a = d.squaredNorm(), b = at.dot(d), c = at.squaredNorm() - slim * slim;
  if (a < 1e-12) return c < 0.0 && r.z() < low;
  const double discriminant = b * b - a * c;
  if (discriminant <= 0.0) return false;
  const double root = std::sqrt(discriminant);
  for (int k = 0; k <= 8; ++k) {  // places inside the chord, for the finite height
    const double along = (-b - root + 2.0 * root * k / 8.0) / a;
    const double z = r.z() + along * view.towards.z();
    if (along > 1e-6 && z > low && z < high) return true;
  }
  return false;
}

std::vector<Vector2d> Drum::rim(const View& view, double z) const {
  std::vector<Vector2d> points;
  for (int k = 0; k <= 96; ++k) {
    const double a = 2.0 * std::numbers::pi * k / 96;
    points.push_back(view.project({radius * std::cos(a), radius * std::sin(a), z}));
  }
  return points;
}

std::vector<Vector2d> Drum::outline(const View& view) const {
  // the half of the far rim below, the half of the near rim above; both are cut where the side turns from view
  const double side = std::atan2(view.right.y(), view.right.x());
  std::vector<Vector2d> points;
  const auto half = [&](double z, double from, double to) {
    for (int k = 0; k <= 48; ++k) {
      const double a = from + (to - from) * k / 48;
      points.push_back(view.project({radius * std::cos(a), radius * std::sin(a), z}));
    }
  };
  const double pi = std::numbers::pi, sign = view.towards.z() >= 0.0 ? 1.0 : -1.0;
  half(high, side, side + sign * pi);
  half(low, side + sign * pi, side + sign * 2.0 * pi);
  points.push_back(points.front());
  return points;
}

Drum drum_for(const RodCurve& curve, double rod_radius) {
  Drum drum;
  drum.radius = 1.0 - rod_radius;
  double low = 0.0, high = 0.0;
  for (const Vector3d& r : curve.r) {
    if (std::hypot(r.x(), r.y()) > 1.6) continue;
    low = std::min(low, r.z()), high = std::max(high, r.z());
  }
  drum.low = low - 0.8 - rod_radius, drum.high = high + 0.8 + rod_radius;
  return drum;
}

}  // namespace windlass::output
