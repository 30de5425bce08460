#include "line_pressure.hpp"

#include <algorithm>
#include <cmath>

#include "dense_samples.hpp"
#include "opened_press.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using Kind = ContactEvent::Kind;

namespace {

/// Where the pressure, least at `dip`, rises above `level` on the way to the line's end in the direction `way`; the end itself
/// if nowhere.
double rises_above(const Dense& line, double level, const Least& dip, int way) {
  const Eigen::Index last = line.s.size() - 1;
  Least before = dip;
  for (Eigen::Index k = way > 0 ? 0 : last; k >= 0 && k <= last; k += way) {
    if ((line.s(k) - dip.s) * way <= 0.0) continue;
    if (line.value(k) >= level)
      return before.s + (line.s(k) - before.s) * (level - before.value) / (line.value(k) - before.value);
    before = {line.value(k), line.s(k)};
  }
  return line.s(way > 0 ? last : 0);
}

/// Pressure between two places where a line pulls, over their pull, that counts as none.
constexpr double next_to_none = 1e-6;

/// Local minima of a line's pressure, the least first; each with where the line pulls about it: no length where it does not.
/// A line that carries no pressure over its length is no less in contact for that; see rod::buckling_margin.
/// @param pressed  a strand presses at one end: the other edge holds what pulls between the two, however short it is
std::vector<ContactEvent> dips(const Piece& line, const Dense& dense, int link, bool begins_at_mid,
                               bool pressed) {
  if (line.buckling) return {{Kind::pressure, link, far, line.s(0)}};
  const double begin = line.s(0), end = line.s(line.s.size() - 1);
  // Pressed evenly it lifts all at once, and a line that shrinks to nothing is not cut.
  Eigen::Index lowest = 0;
  const Eigen::VectorXd& p = dense.value;
  const double least_sample = p.minCoeff(&lowest), range = p.maxCoeff() - least_sample;
  const bool even = range < 1e-6;
  std::vector<ContactEvent> out;
  for (Eigen::Index k = 0; k < p.size(); ++k) {
    // The deepest minimum need not be next to the least sample, but next to one that is hardly less deep.
    constexpr double hardly = 0.05;
    const bool dip = (k == 0 || p(k - 1) > p(k)) && (k + 1 == p.size() || p(k + 1) > p(k)) &&
                     p(k) - least_sample < hardly * range;
    if (k != lowest && (even || !dip)) continue;
    const double before = dense.s(std::max<Eigen::Index>(k - 1, 0)),
                 after = dense.s(std::min(k + 1, p.size() - 1));
    const Least least = least_near(line, line.p, dense.s(k), p(k), before, after);
    ContactEvent event{Kind::pressure, link, least.value, least.s, least.s, least.s};
    event.passes = pressed || (!even && end - begin > 10.0 * least_length);
    if (least.value < 0.0) {
      const double level = -next_to_none * least.value;
      event.from = rises_above(dense, level, least, -1);
      event.to = rises_above(dense, level, least, 1);
      if (begins_at_mid && event.from <= begin) event.from = begin - (event.to - begin);
    }
    const bool known =
        !out.empty() && std::abs(out.back().s - event.s) <= after - before;  // by its neighbour
    if (!known) out.push_back(event);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  return out;
}

/// Length of the gap that opens at a dip inside a line, over the length that the line carries for a pressure of this shape.
double part_of_carried(const ContactEvent& dip) {
  return std::pow(std::max(-dip.value, 0.0) * std::pow(dip.to - dip.from, 4) / carried_inside, 1.0 / 6.0);
}

/// Would gaps in the place of these dips meet, each as long as the line carries it? Next to no line would be left between.
bool would_meet(const ContactEvent& a, const ContactEvent& b) {
  const auto half = [](const ContactEvent& dip) {
    return 0.5 * gap_inside * (dip.to - dip.from) / part_of_carried(dip);
  };
  return a.value < 0.0 && b.value < 0.0 && std::abs(a.s - b.s) < gap_reaches_edge * (half(a) + half(b));
}

/// Positive as long as the line carries the gap that has opened in it: one less the gap's length over that which is carried.
/// Two that would meet are carried until the pressure between them is gone: then they are one.
/// @param dips  of the whole line, past the mid-point of a half chain too
ContactEvent suction(const Dense& line, const ContactEvent& pressure, const std::vector<ContactEvent>& dips,
                     const Presses& presses) {
  ContactEvent event = pressure;
  event.kind = Kind::suction;
  event.passes = false;
  event.redrawn = true;
  event.value = 1.0;
  const double width = event.to - event.from, pull = -pressure.value;
  if (!pressure.passes || !(pull > 0.0)) return event;
  const double begin = line.s(0), end = line.s(line.s.size() - 1);
  const bool mirrored = event.from < begin;  // about the mid-point of a half chain
  if (event.to >= end || (!mirrored && event.from <= begin)) {
    const double force = event.from <= begin && event.to >= end ? std::max(presses.begin, presses.end)
                         : event.to >= end                      ? presses.end
                                                                : presses.begin;
    // A wide one lifts the rod before it does as much to the state: not by more than certificates bear, 1e-9.
    constexpr double carried_height = 4e-8;
    const double part = force > 0.0 ? part_beside_press(pull, width, force)
                                    : std::max(std::cbrt(pull * width * width / carried_beside_touch),
                                               std::pow(pull * std::pow(width, 4) / carried_height, 0.25));
    event.value = 1.0 - part;
    return event;
  }
  for (const ContactEvent& other : dips) {
    const bool apart = other.s < event.from || other.s > event.to;
    if (!apart || !would_meet(pressure, other)) continue;
    double between = 0.0;
    for (Eigen::Index k = 0; k < line.s.size(); ++k)
      if ((line.s(k) - event.s) * (line.s(k) - other.s) < 0.0) between = std::max(between, line.value(k));
    event.value = std::min(event.value, between / pull);
  }
  if (event.value < 1.0) return event;
  const double part = part_of_carried(pressure);
  // Close to an edge it is carried until it reaches past the edge, so that no line is left beyond it. Past it by more than the
  // pressure's third derivative moves the gap: short of the edge, the touch there would press the rod into the surface.
  constexpr double past = 1.1;
  const double middle = 0.5 * (event.from + event.to), carried = width / part;
  const double edge = mirrored ? end - middle : std::min(end - middle, middle - begin);
  const bool close = edge < gap_reaches_edge * 0.5 * gap_inside * carried;
  event.value = 1.0 - (close ? width / std::max(past * 2.0 * edge / gap_inside, 0.5 * carried) : part);
  return event;
}

/// The same dips, and where the line begins at the mid-point of a half chain their images.
std::vector<ContactEvent> on_both_halves(std::vector<ContactEvent> dips, double mid) {
  const std::size_t count = dips.size();
  for (std::size_t k = 0; k < count; ++k) {
    ContactEvent image = dips[k];
    image.s = 2.0 * mid - image.s;
    image.from = 2.0 * mid - dips[k].to;
    image.to = 2.0 * mid - dips[k].from;
    if (dips[k].from > mid) dips.push_back(image);
  }
  return dips;
}

}  // namespace

std::array<ContactEvent, 2> pressure_and_suction(const Piece& line, int link, bool from_mid,
                                                 const Presses& presses) {
  const Dense dense = dense_samples(line, line.p);
  const bool pressed = !from_mid && (presses.begin > 0.0) != (presses.end > 0.0);
  const std::vector<ContactEvent> pressures = dips(line, dense, link, from_mid, pressed);
  const std::vector<ContactEvent> all = from_mid ? on_both_halves(pressures, line.s(0)) : pressures;
  ContactEvent most = suction(dense, pressures.front(), all, presses);
  for (std::size_t k = 1; k < pressures.size(); ++k)
    if (const ContactEvent other = suction(dense, pressures[k], all, presses); other.value < most.value)
      most = other;
  return {pressures.front(), most};
}

}  // namespace windlass::equilibrium
