#include "windlass/discrete_rod/thick_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::discrete_rod {

using Eigen::Vector3d;

namespace {

/// How hard the strand at s presses on the one at `other`, per length.
struct Pressed {
  StrandTouch at;
  double pressure;
};

void add_cylinder(const SplineRod& rod, const ThickMinimum& minimum, ThickContacts& out) {
  double last = -1.0;  // where the bed was pressed on last
  for (int e = 0; e < rod.elements(); ++e)
    for (int q = 0; q < Quadrature::points; ++q) {
      const double t = Quadrature::place[q], s = rod.knot(e) + t * rod.length(e);
      Vector3d outward = rod.position(minimum.x, e, t);
      outward(2) = 0.0;
      const double depth = 1.0 - outward.norm();
      if (depth <= 0.0) continue;
      const double force = minimum.penalties.cylinder * Quadrature::weight[q] * rod.length(e) * depth;
      out.loads.push_back({s, force * outward.normalized()});
      const bool goes_on = last >= 0.0 && s - last < out.range;
      if (!goes_on) out.cylinder.push_back({s, s});
      out.cylinder.back().end = last = s;
    }
}

/// Forces between strands on both of them, and how hard they press where.
std::vector<Pressed> add_strands(const ThickRod& thick, const SplineRod& rod, const ThickMinimum& minimum,
                                 ThickContacts& out) {
  const double reach = 2.0 * thick.radius + minimum.penalties.strand_shift;
  const auto half_turn = [](const Vector3d& v) { return Vector3d(-v(0), v(1), -v(2)); };
  std::vector<Pressed> pressed;
  for (const StrandPair& pair : strand_pairs(rod, minimum.x, reach, M_PI * thick.radius)) {
    const double s = rod.knot(pair.element) + pair.t * rod.length(pair.element),
                 other = rod.knot(pair.other) + pair.other_t * rod.length(pair.other),
                 pressure = minimum.penalties.strands * (reach - pair.distance);
    const Vector3d away =
        (rod.position(minimum.x, pair.element, pair.t) - rod.position(minimum.x, pair.other, pair.other_t)) /
        pair.distance;
    // Each of two strands sees the touch: half the force comes from either.
    const Vector3d force = 0.5 * pair.weight * pressure * away;
    out.loads.push_back({s, force});
    out.loads.push_back({std::abs(other), other < 0.0 ? Vector3d(-half_turn(force)) : Vector3d(-force)});
    pressed.push_back({{std::min(s, std::abs(other)), std::max(s, std::abs(other)), other < 0.0}, pressure});
  }
  return pressed;
}

/// Places that press harder than all within reach.
std::vector<StrandTouch> hardest(std::vector<Pressed> pressed, double reach) {
  const auto together = [&](const Pressed& a, const Pressed& b) {
    return a.at.mirrored == b.at.mirrored && std::abs(a.at.s - b.at.s) < reach &&
           std::abs(a.at.other - b.at.other) < reach;
  };
  std::vector<StrandTouch> out;
  for (const Pressed& p : pressed) {
    const bool most = std::none_of(pressed.begin(), pressed.end(), [&](const Pressed& other) {
      return together(p, other) && other.pressure > p.pressure;
    });
    const bool known = std::any_of(out.begin(), out.end(), [&](const StrandTouch& touch) {
      return together(p, Pressed{touch, 0.0});
    });
    if (!most || known) continue;
    StrandTouch touch = p.at;
    touch.own_image = touch.mirrored && touch.other - touch.s < reach;
    if (touch.own_image) touch.s = touch.other = 0.5 * (touch.s + touch.other);
    out.push_back(touch);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  return out;
}

}  // namespace

ThickContacts contacts_of(const ThickRod& thick, const ThickMinimum& minimum) {
  const SplineRod rod = thick.spline(minimum.h);
  ThickContacts out;
  out.range = 1.5 * minimum.h;
  add_cylinder(rod, minimum, out);
  out.strands = hardest(add_strands(thick, rod, minimum, out), out.range);
  std::sort(out.loads.begin(), out.loads.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  return out;
}

}  // namespace windlass::discrete_rod
