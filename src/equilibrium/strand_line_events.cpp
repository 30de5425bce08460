#include "strand_line_events.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::equilibrium {

using chain::Contact;
using chain::Profile;

namespace {

/// Half the distance between the touches on both sides of one inside a line between strands.
double span_of(const Profile& profile, const chain::Strands& strands, int joint) {
  const auto [before, after] = strands.neighbours(joint);
  return 0.5 * (profile.pieces[after].s(0) - profile.pieces[before].s(0));
}

/// How much nearer strands are between the touches inside a line of theirs, by the pressure p that those stand for: ph⁴/192B.
double nearer_between(const Profile& profile, const chain::Strands& strands, int line) {
  double most = 0.0;
  for (const Contact& c : profile.contacts) {
    if (c.coupling < 0 || strands.line_of(c.joint) != line || !strands.inside_line(c.joint)) continue;
    if (strands.pressed(c.joint) || strands.pressed(strands.partner(c.joint))) continue;
    const double h = span_of(profile, strands, c.joint);
    most = std::max(most, std::abs(c.force) * h * h * h / (192.0 * profile.material.bending_stiffness));
  }
  return most;
}

}  // namespace

double nearer_between_touches(const Profile& profile, const chain::Topology& topology) {
  const chain::Strands strands(topology);
  double most = -1.0;
  for (int l = 0; l < static_cast<int>(strands.lines().size()); ++l)
    if (const chain::StrandLine& line = strands.lines()[l]; !line.on_obstacles && line.links() > 1)
      most = std::max(most, nearer_between(profile, strands, l));
  return most;
}

int line_of_several(const chain::Strands& strands, int link) {
  const int line = strands.line_of(link);
  return line >= 0 && line == strands.line_of(link + 1) && strands.lines()[line].links() > 1 ? line : -1;
}

ContactEvent spare_touches(const Profile& profile, const chain::Strands& strands, int i, int line) {
  ContactEvent event{ContactEvent::Kind::length, i, 1.0, profile.pieces[i].s(0)};
  event.redrawn = true;
  const chain::StrandLine& all = strands.lines()[line];
  if (i == all.first.front() || i == std::min(all.second.front(), all.second.back()))
    event.value =
        nearer_between(profile, strands, line) / (spare_between_strands * carried_between_strands) - 1.0;
  return event;
}

bool pressed_before_end(const chain::Strands& strands, int link) {
  const auto [begin, end] = strands.located_about(link, link + 1);
  const auto presses = [&](int at, int other) {  // of the touches at the place of one joint
    const int line = strands.line_of(other);
    if (line < 0 || strands.inside_line(other) || strands.partner(at) < 0) return false;
    for (int j = at - 1; j >= 0 && strands.welded(j); --j)
      if (strands.pressed(j) && strands.line_of(j) == line) return true;
    for (int j = at + 1; strands.welded(j - 1); ++j)
      if (strands.pressed(j) && strands.line_of(j) == line) return true;
    return false;
  };
  return presses(begin, end) || presses(end, begin);
}

std::optional<ContactEvent> laid_between(const Profile& profile, const chain::Strands& strands, int link) {
  const bool pressed = pressed_before_end(strands, link);
  if (!strands.laid(link) && !strands.laid(link + 1) && !pressed) return std::nullopt;
  const auto keeps = [&](int joint) { return strands.laid(joint) || !strands.inside_line(joint); };
  if (!keeps(link) || !keeps(link + 1)) return std::nullopt;  // located by tangency: it may meet the other
  const auto [begin, end] = strands.located_about(link, link + 1);
  ContactEvent event{ContactEvent::Kind::length, link, 1.0, profile.pieces[link].s(0)};
  const int named = line_of_several(strands, end - 1) < 0 ? end - 1 : begin;
  event.redrawn = pressed;
  const double least = pressed ? press_at_end : least_beside_strand;
  if (link == named)
    event.value = profile.pieces[end].s(0) - profile.pieces[begin].s(0) - least * profile.unit_length;
  return event;
}

double carried_pull(const Profile& profile, const chain::Strands& strands, int joint) {
  if (!strands.inside_line(joint)) return 0.0;
  const double h = span_of(profile, strands, joint);
  return 12.0 * carried_between_strands * profile.material.bending_stiffness / (h * h * h);
}

}  // namespace windlass::equilibrium
