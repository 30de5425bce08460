#include "windlass/discrete_rod/thick_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// The stretch that is its own image and that mirrored strands press on all the way, from its one end to the other; that of a place
/// that is its own image where they press on no more than a touch does. nullopt: the touch does not belong to it.
std::optional<StrandTouch> own_image(const std::vector<Pressed>& pressed, const StrandTouch& touch,
                                     double reach) {
  std::vector<StrandTouch> about;  // from the axis of the half-turn outward
  for (const Pressed& p : pressed)
    if (p.at.mirrored) about.push_back(p.at);
  std::sort(about.begin(), about.end(),
            [](const auto& a, const auto& b) { return a.other - a.s < b.other - b.s; });
  StrandTouch all;
  double apart = 0.0;  // of the two places
  for (const StrandTouch& at : about) {
    if (at.other - at.s - apart >= reach) break;
    all = at, apart = at.other - at.s;
  }
  if (!touch.mirrored || touch.other - touch.s > apart) return std::nullopt;
  all.own_image = true;
  constexpr double touch_reaches = 2.5;
  all.line = apart > touch_reaches * reach;
  if (all.line)
    all.s += 0.5 * reach, all.other -= 0.5 * reach;
  else
    all.s = all.other = 0.5 * (all.s + all.other);
  return all;
}

/// Places that press harder than all within reach. @param lines  where strands press on their own image all the way, that is a line
std::vector<StrandTouch> hardest(std::vector<Pressed> pressed, double reach, bool lines) {
  const auto together = [&](const StrandTouch& a, const StrandTouch& b) {
    return a.mirrored == b.mirrored && std::abs(a.s - b.s) < reach && std::abs(a.other - b.other) < reach;
  };
  std::vector<StrandTouch> out;
  const auto add = [&](const StrandTouch& touch) {
    if (std::none_of(out.begin(), out.end(),
                     [&](const StrandTouch& other) { return together(touch, other); }))
      out.push_back(touch);
  };
  for (const Pressed& p : pressed) {
    const bool most = std::none_of(pressed.begin(), pressed.end(), [&](const Pressed& other) {
      return together(p.at, other.at) && other.pressure > p.pressure;
    });
    if (!most) continue;
    StrandTouch touch = p.at;
    if (lines) {
      touch = own_image(pressed, p.at, reach).value_or(p.at);
    } else if (touch.mirrored && touch.other - touch.s < reach) {
      touch.own_image = true;
      touch.s = touch.other = 0.5 * (touch.s + touch.other);
    }
    add(touch);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  return out;
}

}  // namespace

ThickContacts scaled(ThickContacts contacts, double factor) {
  for (LyingStretch& lying : contacts.cylinder) lying.begin *= factor, lying.end *= factor;
  for (StrandTouch& touch : contacts.strands) touch.s *= factor, touch.other *= factor;
  for (PointLoad& load : contacts.loads) load.s *= factor, load.force /= factor * factor;
  contacts.range *= factor;
  return contacts;
}

ThickContacts contacts_of(const ThickRod& thick, const ThickMinimum& minimum, bool lines) {
  const SplineRod rod = thick.spline(minimum.h);
  ThickContacts out;
  out.range = 1.5 * minimum.h;
  if (thick.cylinder) add_cylinder(rod, minimum, out);
  out.strands = hardest(add_strands(thick, rod, minimum, out), out.range, lines);
  std::sort(out.loads.begin(), out.loads.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  return out;
}

}  // namespace windlass::discrete_rod
