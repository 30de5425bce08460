#include <utility>
#include <vector>

#include "checks.hpp"
#include "slaved_pressure.hpp"
#include "windlass/verify/shadow.hpp"

namespace windlass::verify {

using equilibrium::ArcKind;
using equilibrium::ArcRecord;
using equilibrium::Solution;

Section sample(const ArcRecord& arc, Eigen::Index i) {
  return {arc.r.col(i), arc.q.col(i), arc.m.col(i), arc.n.col(i)};
}
Section first_section(const ArcRecord& arc) { return sample(arc, 0); }
Section last_section(const ArcRecord& arc) { return sample(arc, arc.s.size() - 1); }

double frame_distance(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return std::min((a - b).norm(), (a + b).norm());
}

const Shape* shape_of(const std::vector<Shape>& shapes, int obstacle) {
  if (shapes.size() == 1) return &shapes.front();
  return obstacle >= 0 && obstacle < static_cast<int>(shapes.size()) ? &shapes[obstacle] : nullptr;
}

// By height and slope: what has left the plate is within 1e-9 of it for a thousandth, but not as little inclined.
bool on_plate(const ArcRecord& arc, const scene::Scene& scene) {
  if (!scene.plate || (arc.r.row(2).array() - scene.plate->height).abs().maxCoeff() >= tight) return false;
  for (Eigen::Index i = 0; i < arc.s.size(); ++i)
    if (std::abs(tangent(sample(arc, i)).z()) >= tight) return false;
  return true;
}

namespace {

/// Distance of a section from an obstacle with its first and second derivative along the rod.
struct Gap {
  double value, rate, bend = 0.0;
  Gap(double v, double r) : value(v), rate(r) {}
  Gap(const Section& x, const Shape& shape)
      : value(shape.gap(x.r)), rate(shape.outward(x.r, tangent(x)).dot(tangent(x))) {}
  /// On a free arc: r' = λ t, n' = −weight.
  Gap(const Section& x, const Shape& shape, const Stiffness& law) : Gap(x, shape) {
    const Eigen::Matrix3d d = rotation(x.q);
    const Eigen::Vector3d t = d.col(2), slope = (d * law.strain(x)).cross(t);
    const double stretch = law.stretch(x), stretch_rate = law.k * (x.n.dot(slope) - law.weight.dot(t));
    bend = stretch * shape.outward(x.r, t).dot(slope) + stretch_rate * rate +
           stretch * stretch * shape.bend(x.r, t);
    rate *= stretch;
  }
};

/// Smallest value of the cubic with the given values and rates at two places a step h apart.
double smallest_of_cubic(const Gap& a, const Gap& b, double h) {
  double smallest = std::min(a.value, b.value);
  if (a.rate >= 0.0 || b.rate <= 0.0) return smallest;  // no dip inside
  // cubic in x = s/h: value + A x + B x² + C x³; its rate A + 2B x + 3C x² vanishes where it dips
  const double A = h * a.rate, D = b.value - a.value, B = 3.0 * D - 2.0 * A - h * b.rate,
               C = h * b.rate + A - 2.0 * D;
  // of the two roots of A + 2Bx + 3Cx² the minimum is the one with rising rate, in its form without cancellation
  const double root = std::sqrt(std::max(0.0, B * B - 3.0 * A * C));
  const double x = B >= 0.0 ? -A / (B + root) : (root - B) / (3.0 * C);
  if (x > 0.0 && x < 1.0) smallest = std::min(smallest, a.value + x * (A + x * (B + x * C)));
  return smallest;
}

/// Smallest value between two places: of the quintic through both, in parts. A cubic from place to place would dip where
/// the gap leaves a touch with its fourth power, as it does when the touch is about to flatten.
double smallest_between(const Gap& a, const Gap& b, double h) {
  constexpr int parts = 8;
  const double c0 = a.value, c1 = h * a.rate, c2 = 0.5 * h * h * a.bend;
  const double D = b.value - c0 - c1 - c2, E = h * b.rate - c1 - 2.0 * c2, F = h * h * b.bend - 2.0 * c2;
  const double c3 = 10.0 * D - 4.0 * E + 0.5 * F, c4 = -15.0 * D + 7.0 * E - F,
               c5 = 6.0 * D - 3.0 * E + 0.5 * F;
  const auto at = [&](double x) {
    return Gap(c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))),
               (c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / h);
  };
  double smallest = std::min(a.value, b.value);
  Gap last(a.value, a.rate);
  for (int k = 1; k <= parts; ++k) {
    const Gap next = k == parts ? Gap(b.value, b.rate) : at(static_cast<double>(k) / parts);
    smallest = std::min(smallest, smallest_of_cubic(last, next, h / parts));
    last = next;
  }
  return smallest;
}

/// The same past the outer edge of a plate, where the gap's curvature jumps, or its slope: of the gap itself, along the quintic way
/// through both places.
double smallest_past_edge(const Section& a, const Section& b, const Shape& shape, const Stiffness& law,
                          double h) {
  constexpr int parts = 64;
  const auto derivatives = [&](const Section& x) {
    const Eigen::Matrix3d d = rotation(x.q);
    const Eigen::Vector3d t = d.col(2), slope = (d * law.strain(x)).cross(t);
    const double stretch = law.stretch(x), rate = law.k * (x.n.dot(slope) - law.weight.dot(t));
    return std::pair<Eigen::Vector3d, Eigen::Vector3d>(h * stretch * t, h * h * (stretch * slope + rate * t));
  };
  const auto [v, w] = derivatives(a);
  const auto [v_b, w_b] = derivatives(b);
  const Eigen::Vector3d D = b.r - a.r - v - 0.5 * w, E = v_b - v - w, F = w_b - w;
  const Eigen::Vector3d c3 = 10.0 * D - 4.0 * E + 0.5 * F, c4 = -15.0 * D + 7.0 * E - F,
                        c5 = 6.0 * D - 3.0 * E + 0.5 * F;
  double smallest = std::min(shape.gap(a.r), shape.gap(b.r));
  for (int k = 1; k < parts; ++k) {
    const double x = static_cast<double>(k) / parts;
    const Eigen::Vector3d r = a.r + x * (v + x * (0.5 * w + x * (c3 + x * (c4 + x * c5))));
    smallest = std::min(smallest, shape.gap(r));
  }
  return smallest;
}

/// What the integration of all arcs collects.
struct Collected {
  Largest position, frame, moment, force, off_surface, pressure, arc_force;
  Smallest gap, smallest_pressure;
  std::vector<std::pair<double, double>> pressures;  // of the present line: place and pressure there
  double virial = 0.0;
};

/// The rod lifts where a line pulls. A beam of EI = 1 under a suction of that depth and width, parabolic along it, rises by
/// p h⁴/72 over a gap of half-length h, and suction is √5 times less wide than the gap: where that is no height at all, the line
/// stands for the gap. What pulls otherwise counts as negative pressure.
void judge_pressures(const Scales& scales, Collected& found) {
  const auto& all = found.pressures;
  const auto zero_between = [&](std::size_t k, std::size_t next) {
    const auto [s, p] = all[k];
    return s + (all[next].first - s) * p / (p - all[next].second);
  };
  for (std::size_t k = 0; k < all.size(); ++k) {
    double deepest = all[k].second;
    if (!(deepest < 0.0)) {
      found.smallest_pressure.add(deepest / scales.force);
      continue;
    }
    const double from = k > 0 ? zero_between(k, k - 1) : all[k].first;
    while (k + 1 < all.size() && all[k + 1].second < 0.0) deepest = std::min(deepest, all[++k].second);
    const double to = k + 1 < all.size() ? zero_between(k, k + 1) : all[k].first;
    const double half = 0.5 * std::sqrt(5.0) * (to - from), height = -deepest * std::pow(half, 4) / 72.0;
    found.smallest_pressure.add(height < tight ? 0.0 : deepest / scales.force);
  }
  found.pressures.clear();
}

/// Places looked at between two samples, for the gap: the quintic between two of them is off by the sixth power of their distance.
int looks_along(double growth_lengths) {
  constexpr int least = 4;
  constexpr double apart = 0.2;
  return std::max(least, static_cast<int>(std::ceil(growth_lengths / apart)));
}

void compare(const Section& reached, const Section& stored, const Scales& scales, Collected& found) {
  found.position.add((reached.r - stored.r).norm());
  found.frame.add(frame_distance(reached.q, stored.q));
  found.moment.add((reached.m - stored.m).norm() / scales.moment);
  found.force.add((reached.n - stored.n).norm() / scales.force);
}

/// What is checked against: the material, the obstacles, and the one that an arc lies on.
struct Surroundings {
  const Stiffness& law;
  const std::vector<Shape>& shapes;
  const Shape& below;
  bool layered() const { return has_layers(law, below); }
  double width(const Section& x) const { return layer_width(x, law, below); }
  double pressure(const Section& x) const {
    if (below.wall()) return plane_pressure(x, law, *below.wall());
    return law.stretches() ? stretched_surface_pressure(x, law) : surface_pressure(x, law.K[0]);
  }
};

void check_sample(const ArcRecord& arc, Eigen::Index i, const Surroundings& around, const Scales& scales,
                  Collected& found) {
  if (arc.kind != ArcKind::line || arc.s_end - arc.s_begin < tight) return;  // vanishes at an event
  const Section stored = sample(arc, i);
  const double pressure = arc.p[i];
  found.pressures.emplace_back(arc.s[i], pressure);
  found.off_surface.add(std::abs(Gap(stored, around.below).value));
  found.off_surface.add(std::abs(Gap(stored, around.below).rate));
  const double off = around.layered()
                         ? taken_by_friction(stored, around.law) - pressure * around.width(stored)
                         : pressure - around.pressure(stored);
  found.pressure.add(std::abs(off) / scales.force);
}

/// What is true along a trajectory between two samples: distance from the obstacles, sign of the pressure.
void look_along(const std::vector<Section>& sections, double begin, double h, ArcKind kind,
                const Surroundings& around, Collected& found) {
  for (std::size_t k = 1; k < sections.size(); ++k) {
    if (kind == ArcKind::line) {
      found.off_surface.add(std::abs(Gap(sections[k], around.below).value));
      if (!around.layered())
        found.pressures.emplace_back(begin + static_cast<double>(k) * h, around.pressure(sections[k]));
    }
    for (const Shape& shape : around.shapes) {
      if (kind != ArcKind::free && &shape == &around.below) continue;
      const Section &from = sections[k - 1], &to = sections[k];
      const Shape inside = shape.without_edge();
      found.gap.add(shape.past_edge(from.r) || shape.past_edge(to.r)
                        ? smallest_past_edge(from, to, shape, around.law, h)
                        : smallest_between(Gap(from, inside, around.law), Gap(to, inside, around.law), h));
    }
  }
}

bool close(const Section& a, const Section& b, const Scales& scales) {
  Collected found;
  compare(a, b, scales, found);
  return std::max({found.position.value(), found.frame.value(), found.moment.value(), found.force.value()}) <
         0.1 * tight;
}

/// Is the layer of a piece's pressure short beside it, or is there none of one direction?
bool is_slaved(double left, double right, double length) {
  constexpr double many = 30.0;
  return left * right <= 0.0 || length > many * std::min(std::abs(left), std::abs(right));
}

/// From one sample to the next of a line whose pressure has layers: the way that it flows.
double integrate_layered(RodFlow& flow, const ArcRecord& arc, Eigen::Index i, const Surroundings& around,
                         const Scales& scales, Collected& found) {
  const Section left = sample(arc, i), right = sample(arc, i + 1);
  const double w = around.width(right), length = arc.s[i + 1] - arc.s[i];
  const bool backward = w > 0.0;
  const Section &start = backward ? right : left, &goal = backward ? left : right;
  const int looks = looks_along(scales.moment / std::sqrt(around.law.K[0]) * length);
  SlavedPiece piece;
  if (is_slaved(around.width(left), w, length)) {
    piece = find_slaved(flow, around.law, around.below, start, length, 0.5 * (arc.p[i] + arc.p[i + 1]),
                        backward, looks);
    if (!piece.converged) found.position.add(NAN);
  } else {
    flow.restart(start, backward);
    piece.stations = {start};
    for (int k = 1; k <= looks; ++k)
      piece.stations.push_back(flow.advance(k == looks ? length : k * length / looks));
    for (const Section& x : piece.stations)
      piece.pressures.push_back(taken_by_friction(x, around.law) / around.width(x));
    piece.contact_force = std::abs(flow.contact_force());
  }
  compare(piece.stations.back(), goal, scales, found);
  if (backward) {
    std::reverse(piece.stations.begin(), piece.stations.end());
    std::reverse(piece.pressures.begin(), piece.pressures.end());
  }
  for (int k = 1; k < looks; ++k)
    found.pressures.emplace_back(arc.s[i] + k * length / looks, piece.pressures[static_cast<std::size_t>(k)]);
  look_along(piece.stations, arc.s[i], length / looks, arc.kind, around, found);
  return piece.contact_force;
}

/// Integrates from one sample to the next. @return the contact force on the way
double integrate_piece(RodFlow& flow, const ArcRecord& arc, Eigen::Index i, const Surroundings& around,
                       const Scales& scales, Collected& found) {
  const Section start = sample(arc, i), stored = sample(arc, i + 1);
  const double length = arc.s[i + 1] - arc.s[i], growth = scales.moment / std::sqrt(around.law.K[0]);
  if (std::abs(length) < tight) {  // an arc that vanishes at an event: both samples are one place
    compare(start, stored, scales, found);
    return arc.kind == ArcKind::line ? 0.5 * (arc.p[i] + arc.p[i + 1]) * length : 0.0;
  }
  std::vector<Section> sections = {start};
  if (arc.kind == ArcKind::line && around.layered())
    return integrate_layered(flow, arc, i, around, scales, found);
  // plain integration, the cheap and direct way; after it has lost e^20 there is no point in trying
  if (growth * length < 20.0) {
    flow.restart(start);
    const int looks = looks_along(growth * std::abs(length));
    for (int k = 1; k <= looks; ++k)
      sections.push_back(flow.advance(k == looks ? length : k * length / looks));
    if (growth * length < 1.0 || close(sections.back(), stored, scales)) {
      compare(sections.back(), stored, scales, found);
      look_along(sections, arc.s[i], length / looks, arc.kind, around, found);
      found.virial += flow.virial();
      return flow.contact_force();
    }
  }
  const Shadow shadow = find_shadow(flow, arc.kind, start, stored, length, growth);
  compare(shadow.start, start, scales, found);
  compare(shadow.end, stored, scales, found);
  if (!shadow.converged) found.position.add(NAN);
  look_along(shadow.stations, arc.s[i], length / static_cast<double>(shadow.stations.size() - 1), arc.kind,
             around, found);
  found.virial += shadow.virial;
  return shadow.contact_force;
}

void integrate(const ArcRecord& arc, const Surroundings& around, const Scales& scales, Collected& found) {
  RodFlow flow(around.law, arc.kind, scales.tolerance, around.below);
  double contact_force = 0.0;
  check_sample(arc, 0, around, scales, found);
  for (Eigen::Index i = 0; i + 1 < arc.s.size(); ++i) {
    contact_force += integrate_piece(flow, arc, i, around, scales, found);
    check_sample(arc, i + 1, around, scales, found);
  }
  if (arc.kind == ArcKind::line) {
    judge_pressures(scales, found);
    // a long arc adds up forces of size T over its length
    const double size = scales.force * std::max(1.0, arc.s[arc.s.size() - 1] - arc.s[0]);
    found.arc_force.add(std::abs(contact_force - arc.force) / size);
  }
}

}  // namespace

double check_arcs(const Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list) {
  const Stiffness law(scene.rod);
  const std::vector<Shape> shapes = shapes_of(scene, solution.travel_rate);
  const Shape none = Shape::cylinder();  // of free arcs
  Collected found;
  Largest norm;
  bool any_line = false;
  for (const ArcRecord& arc : solution.arcs) {
    any_line = any_line || arc.kind == ArcKind::line;
    for (Eigen::Index i = 0; i < arc.s.size(); ++i) norm.add(std::abs(arc.q.col(i).norm() - 1.0));
    const Shape* below = arc.kind == ArcKind::line ? shape_of(shapes, arc.obstacle) : nullptr;
    const bool flat = below && on_plate(arc, scene);
    // A line on nothing; or with what this integration has not: beside a plate, a stretch by the friction along it.
    const bool stretched =
        below && law.stretches() && below->drags() && flat && std::abs(solution.travel_rate) >= tight;
    if (arc.kind == ArcKind::line && (!below || stretched)) found.off_surface.add(NAN);
    const Shape pressed = !below ? none : flat ? below->beside_plate() : *below;
    integrate(arc, {law, shapes, pressed}, scales, found);
  }
  list.at_most("unit_quaternions", norm.value(), tight, "largest | |q| - 1 |");
  list.at_most("arc_position", found.position.value(), tight,
               "integrated against stored r at the next sample");
  list.at_most("arc_frame", found.frame.value(), tight, "integrated against stored q");
  list.at_most("arc_moment", found.moment.value(), tight, "integrated against stored m, / max(1, sqrt(T))");
  list.at_most("arc_force", found.force.value(), tight, "integrated against stored n, / max(1, T)");
  if (found.gap.any())
    list.at_least("gap", found.gap.value(), -tight, "smallest distance of free arcs from the obstacles");
  if (!any_line) return found.virial;
  list.at_most("on_surface", found.off_surface.value(), tight,
               "distance from the obstacle and slope to it on line arcs");
  list.at_least(
      "pressure", found.smallest_pressure.value(), -tight,
      "smallest contact pressure, / max(1, T), but for suction that lifts the rod by less than 1e-9");
  list.at_most("pressure_balance", found.pressure.value(), 10.0 * tight,
               "stored p against p from the balance of forces, / max(1, T)");
  list.at_most("line_contact_force", found.arc_force.value(), tight,
               "stored force of line arcs against ∫ p ds, / (max(1, T) max(1, arc length))");
  return found.virial;
}

}  // namespace windlass::verify
