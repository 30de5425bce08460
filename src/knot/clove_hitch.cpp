#include <algorithm>
#include <cmath>

#include "windlass/knot/start_curve.hpp"

namespace windlass::knot {

namespace {

/// From 0 to 1 with two continuous derivatives.
double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 - t * (15.0 - 6.0 * t));
}

}  // namespace

Curve clove_hitch(double radius) {
  // All in radii of the rod: how high the middle strand passes over the tails, how far its turn keeps off the tails, and these
  // off the middle plane, each a little more than strands need.
  const double over = 2.7 * radius, turn = 3.2 * radius, tail = 1.05 * radius;
  constexpr double across = 0.9, down_from = 0.3, down_to = 1.6;  // angles of the middle strand [rad]
  constexpr double aside = 4.6, whole = 2.0 * M_PI;  // from where the turn comes back to the tails
  constexpr int corners = 800;
  Curve curve;
  for (int k = 0; k <= corners; ++k) {
    const double a = whole * k / corners;
    const double height = 1.0 + over * (1.0 - smooth_step((a - down_from) / (down_to - down_from)));
    double z = turn * (2.0 * smooth_step(0.5 * (a / across + 1.0)) - 1.0);
    if (a > aside) z = turn + (tail - turn) * smooth_step((a - aside) / (whole - aside));
    curve.emplace_back(height * std::sin(a), -height * std::cos(a), z);
  }
  curve.emplace_back(1.0, -1.0, tail);
  return curve;
}

}  // namespace windlass::knot
