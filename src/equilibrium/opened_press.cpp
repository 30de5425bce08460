#include "opened_press.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::equilibrium {

using chain::Piece;

double part_beside_press(double pull, double width, double force) {
  constexpr double levers = 15.0, carried_height = 3e-8;  // pull width⁴ of 1e-9 or so
  const double gap = gap_beside_touch * width, lever = pull * gap * gap / (36.0 * force);
  return std::max(std::cbrt(lever / (levers * least_lever)),
                  std::pow(pull * std::pow(width, 4) / carried_height, 0.2));
}

Presses presses_on(const chain::Profile& profile, int link) {
  const auto force = [&](int joint) {
    const chain::Contact* there = profile.contact_at(joint);
    return there && there->reaction ? std::max(*there->reaction, 0.0) : 0.0;
  };
  return {force(link), force(link + 1)};
}

std::optional<OpenedPress> opened_press(const chain::Profile& profile, const chain::Topology& topology,
                                        int link) {
  using chain::Stretch;
  const int last = static_cast<int>(topology.stretches.size()) - 1;
  const auto between_lines = [&](int first) {  // a gap, a strand, a gap
    return first > 0 && first + 2 <= last && topology.seat(first + 1).strand != 0 &&
           topology.stretches[first - 1] == Stretch::line && topology.stretches[first] == Stretch::gap &&
           topology.stretches[first + 1] == Stretch::gap && topology.stretches[first + 2] == Stretch::line;
  };
  for (const int first : {link - 1, link})
    if (between_lines(first)) {
      const bool lever_first = profile.pieces[first].length() < profile.pieces[first + 1].length();
      return lever_first ? OpenedPress{first + 1, first} : OpenedPress{first, first + 1};
    }
  return std::nullopt;
}

double part_of_carried(const chain::Profile& profile, const OpenedPress& opened) {
  const int edge = opened.lever < opened.gap ? opened.lever : opened.lever + 1;
  const double lever = profile.pieces[opened.lever].length(), gap = profile.pieces[opened.gap].length();
  const double force = std::max(profile.contact_at(edge)->force, 0.0);
  return force > 0.0 ? part_beside_press(36.0 * force * lever / (gap * gap), gap / gap_beside_touch, force)
                     : 0.0;
}

double lever_under_press(const Piece& line, bool at_end, double gap, double force) {
  const Eigen::Index last = line.s.size() - 1, here = at_end ? last : 0, beside = at_end ? last - 1 : 1;
  const double slope = (line.p(beside) - line.p(here)) / std::abs(line.s(beside) - line.s(here));
  return std::max(slope, 0.0) * std::pow(gap, 3) / (60.0 * force);
}

std::optional<double> pressed_by(const chain::Profile& profile, const Strip& strip, int joint) {
  if (!strip.is_line(joint - 1) || !strip.is_line(joint) || strip.on[joint].strand == 0) return std::nullopt;
  const double force = presses_on(profile, joint).begin;
  return force > 0.0 ? std::optional(force) : std::nullopt;
}

Successor opened_under_press(int link, Strip strip, const chain::Profile& profile, bool at_end, double gap) {
  const int i = link, joint = at_end ? i + 1 : i, beyond = at_end ? i + 1 : i - 1;
  const double s = strip.s[joint], room = std::abs(strip.s[beyond + 1] - strip.s[beyond]);
  const double lever =
      std::clamp(lever_under_press(profile.pieces[i], at_end, gap, *pressed_by(profile, strip, joint)),
                 2.0 * least_lever * profile.unit_length, 0.5 * room);
  chain::Seat edge{strip.on[joint].obstacle};
  edge.flat = strip.on[joint].flat;  // of what lies behind it
  const auto open = [&](int part, double at, chain::Stretch left, chain::Stretch right) {
    strip.split(part, at, left, right, edge);
    strip.parts[left == chain::Stretch::gap ? part : part + 1].fresh = true;
  };
  // The part that comes last first, which leaves the others their numbers.
  open(joint, s + (at_end ? lever : gap), chain::Stretch::gap, chain::Stretch::line);
  open(joint - 1, s - (at_end ? gap : lever), chain::Stretch::line, chain::Stretch::gap);
  chain::Seat& press = strip.on[joint + 1];
  if (press.flat >= 0) press.obstacle = press.flat;  // it is in the plate
  Successor next = strip.successor();
  std::sort(next.opened.begin(), next.opened.end(), [&](int a, int b) {  // entered by the length of the gap
    return next.s[a + 1] - next.s[a] > next.s[b + 1] - next.s[b];
  });
  return next;
}

Successor lifted_beside_press(int link, Strip strip, const chain::Profile& profile, bool at_end) {
  const int joint = at_end ? link + 1 : link, beyond = at_end ? joint : joint - 1;
  const double length = strip.s[link + 1] - strip.s[link], room = strip.s[beyond + 1] - strip.s[beyond];
  const double moment = -profile.pieces[link].p.minCoeff() * length * length / 12.0;
  const double lever = std::clamp(moment / *pressed_by(profile, strip, joint),
                                  2.0 * least_beside_strand * profile.unit_length, 0.5 * room);
  chain::Seat edge{strip.on[joint].obstacle};
  edge.flat = strip.on[joint].flat;
  strip.parts[link].kind = chain::Stretch::gap;
  if (chain::Seat& press = strip.on[joint]; press.flat >= 0) press.obstacle = press.flat;
  const chain::Stretch line = chain::Stretch::line, gap = chain::Stretch::gap;
  strip.split(beyond, strip.s[joint] + (at_end ? lever : -lever), at_end ? gap : line, at_end ? line : gap,
              edge);
  strip.parts[at_end ? beyond : beyond + 1].fresh = true;
  return strip.successor();
}

Successor closed_under_press(const OpenedPress& opened, Strip strip) {
  const int first = std::min(opened.gap, opened.lever);
  chain::Seat& press = strip.on[first + 1];
  press.obstacle = strip.on[first].obstacle;
  press.flat = strip.on[first + 2].flat;  // of the line behind
  strip.merge(first + 1, first + 2, chain::Stretch::line);
  strip.merge(first - 1, first, chain::Stretch::line);
  return strip.successor();
}

}  // namespace windlass::equilibrium
