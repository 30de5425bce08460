#include "checks.hpp"
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

Eigen::Vector3d outward_normal(const Eigen::Vector3d& r) {
  return Eigen::Vector3d(r.x(), r.y(), 0.0).normalized();
}

namespace {

/// Distance of a section from the cylinder and its rate along the rod.
struct Gap {
  double value, rate;
  explicit Gap(const Section& x)
      : value(std::hypot(x.r.x(), x.r.y()) - 1.0), rate(outward_normal(x.r).dot(tangent(x))) {}
};

/// Smallest value between two places a step h apart of the cubic with the given values and rates at both.
double smallest_between(const Gap& a, const Gap& b, double h) {
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

/// What the integration of all arcs collects.
struct Collected {
  Largest position, frame, moment, force, off_surface, pressure, arc_force;
  Smallest gap, smallest_pressure;
};

/// Places looked at between two samples, for the gap.
constexpr int looks = 4;

void compare(const Section& reached, const Section& stored, const Scales& scales, Collected& found) {
  found.position.add((reached.r - stored.r).norm());
  found.frame.add(frame_distance(reached.q, stored.q));
  found.moment.add((reached.m - stored.m).norm() / scales.moment);
  found.force.add((reached.n - stored.n).norm() / scales.force);
}

void check_sample(const ArcRecord& arc, const Section& stored, double pressure, const Stiffness& law,
                  const Scales& scales, Collected& found) {
  if (arc.kind != ArcKind::line) return;
  found.off_surface.add(std::abs(Gap(stored).value));
  found.off_surface.add(std::abs(Gap(stored).rate));
  found.pressure.add(std::abs(pressure - surface_pressure(stored, law.K[0])) / scales.force);
  found.smallest_pressure.add(pressure / scales.force);
}

/// What is true along a trajectory between two samples: distance from the cylinder, sign of the pressure.
void look_along(const std::vector<Section>& sections, double h, ArcKind kind, bool has_cylinder,
                const Stiffness& law, const Scales& scales, Collected& found) {
  for (std::size_t k = 1; k < sections.size(); ++k) {
    if (kind == ArcKind::line) {
      found.off_surface.add(std::abs(Gap(sections[k]).value));
      found.smallest_pressure.add(surface_pressure(sections[k], law.K[0]) / scales.force);
    } else if (has_cylinder) {
      found.gap.add(smallest_between(Gap(sections[k - 1]), Gap(sections[k]), h));
    }
  }
}

bool close(const Section& a, const Section& b, const Scales& scales) {
  Collected found;
  compare(a, b, scales, found);
  return std::max({found.position.value(), found.frame.value(), found.moment.value(), found.force.value()}) <
         0.1 * tight;
}

/// Integrates from one sample to the next. @return the contact force on the way
double integrate_piece(RodFlow& flow, const ArcRecord& arc, Eigen::Index i, bool has_cylinder,
                       const Stiffness& law, const Scales& scales, Collected& found) {
  const Section start = sample(arc, i), stored = sample(arc, i + 1);
  const double length = arc.s[i + 1] - arc.s[i], growth = scales.moment / std::sqrt(law.K[0]);
  if (std::abs(length) < tight) {  // an arc that vanishes at an event: both samples are one place
    compare(start, stored, scales, found);
    return arc.kind == ArcKind::line ? 0.5 * (arc.p[i] + arc.p[i + 1]) * length : 0.0;
  }
  std::vector<Section> sections = {start};
  // plain integration, the cheap and direct way; after it has lost e^20 there is no point in trying
  if (growth * length < 20.0) {
    flow.restart(start);
    for (int k = 1; k <= looks; ++k)
      sections.push_back(flow.advance(k == looks ? length : k * length / looks));
    if (growth * length < 1.0 || close(sections.back(), stored, scales)) {
      compare(sections.back(), stored, scales, found);
      look_along(sections, length / looks, arc.kind, has_cylinder, law, scales, found);
      return flow.contact_force();
    }
  }
  const Shadow shadow = find_shadow(flow, arc.kind, start, stored, length, growth);
  compare(shadow.start, start, scales, found);
  compare(shadow.end, stored, scales, found);
  if (!shadow.converged) found.position.add(NAN);
  look_along(shadow.stations, length / static_cast<double>(shadow.stations.size() - 1), arc.kind,
             has_cylinder, law, scales, found);
  return shadow.contact_force;
}

void integrate(const ArcRecord& arc, const Stiffness& law, bool has_cylinder, const Scales& scales,
               Collected& found) {
  RodFlow flow(law, arc.kind, scales.tolerance);
  double contact_force = 0.0;
  check_sample(arc, sample(arc, 0), arc.p[0], law, scales, found);
  for (Eigen::Index i = 0; i + 1 < arc.s.size(); ++i) {
    contact_force += integrate_piece(flow, arc, i, has_cylinder, law, scales, found);
    check_sample(arc, sample(arc, i + 1), arc.p[i + 1], law, scales, found);
  }
  if (arc.kind == ArcKind::line) {
    // a long arc adds up forces of size T over its length
    const double size = scales.force * std::max(1.0, arc.s[arc.s.size() - 1] - arc.s[0]);
    found.arc_force.add(std::abs(contact_force - arc.force) / size);
  }
}

}  // namespace

void check_arcs(const Solution& solution, const scene::Scene& scene, const Scales& scales, CheckList& list) {
  const Stiffness law(scene.rod);
  Collected found;
  Largest norm;
  bool any_line = false;
  for (const ArcRecord& arc : solution.arcs) {
    any_line = any_line || arc.kind == ArcKind::line;
    for (Eigen::Index i = 0; i < arc.s.size(); ++i) norm.add(std::abs(arc.q.col(i).norm() - 1.0));
    integrate(arc, law, solution.has_cylinder, scales, found);
  }
  list.at_most("unit_quaternions", norm.value(), tight, "largest | |q| - 1 |");
  list.at_most("arc_position", found.position.value(), tight,
               "integrated against stored r at the next sample");
  list.at_most("arc_frame", found.frame.value(), tight, "integrated against stored q");
  list.at_most("arc_moment", found.moment.value(), tight, "integrated against stored m, / max(1, sqrt(T))");
  list.at_most("arc_force", found.force.value(), tight, "integrated against stored n, / max(1, T)");
  if (found.gap.any())
    list.at_least("gap", found.gap.value(), -tight, "smallest distance of free arcs from the cylinder");
  if (!any_line) return;
  list.at_most("on_surface", found.off_surface.value(), tight,
               "distance from the cylinder and slope to it on line arcs");
  list.at_least("pressure", found.smallest_pressure.value(), -tight,
                "smallest contact pressure, / max(1, T)");
  list.at_most("pressure_balance", found.pressure.value(), 10.0 * tight,
               "stored p against p from the balance of forces, / max(1, T)");
  list.at_most("line_contact_force", found.arc_force.value(), tight,
               "stored force of line arcs against ∫ p ds, / (max(1, T) max(1, arc length))");
}

}  // namespace windlass::verify
