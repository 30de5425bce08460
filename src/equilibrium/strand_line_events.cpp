#include "strand_line_events.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

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

bool touches_too_near(const Profile& profile, const chain::Topology& topology) {
  const chain::Strands strands(topology);
  for (int i = 0; i < static_cast<int>(profile.pieces.size()); ++i) {
    const bool between = strands.inside_line(i) && strands.inside_line(i + 1) && !strands.welded(i) &&
                         (strands.laid(i) || strands.laid(i + 1));
    if (between && profile.pieces[i].length() < laid_too_near * profile.unit_length) return true;
  }
  return false;
}

bool pressed_without_touch(const Profile& profile, const chain::Topology& topology) {
  constexpr double beyond = 1.3;  // the distance from which on a touch is laid, or that would be its edge
  const chain::Strands strands(topology);
  const auto apart = [&](int one, int two) {
    return std::abs(profile.pieces[one].s(0) - profile.pieces[two].s(0));
  };
  const auto without = [&](const std::vector<int>& strand, std::size_t k, int joint) {
    if (strands.partner(joint) < 0 || strands.inside_line(joint)) return false;
    if (apart(joint, strand[k]) == 0.0 || apart(joint, strand[k + 1]) == 0.0) return false;
    const double from_ends = std::min(apart(joint, strand.front()), apart(joint, strand.back()));
    return from_ends > beyond * press_apart * profile.unit_length;
  };
  for (const chain::StrandLine& line : strands.lines())
    for (const auto* strand : {&line.first, &line.second}) {
      if (line.on_obstacles) continue;
      for (std::size_t k = 0; k + 1 < strand->size(); ++k) {
        const auto [low, high] = std::minmax((*strand)[k], (*strand)[k + 1]);
        if (!strands.laid(low) && !strands.laid(high)) continue;
        for (int j = low + 1; j < high; ++j)
          if (without(*strand, k, j)) return true;
      }
    }
  return false;
}

int line_of_several(const chain::Strands& strands, int link) {
  const int line = strands.line_of(link);
  return line >= 0 && line == strands.line_of(link + 1) && strands.lines()[line].links() > 1 ? line : -1;
}

namespace {

/// The same of a line or of others that have touches at the places of its own, for they need theirs.
double nearer_at_same_places(const Profile& profile, const chain::Strands& strands, int line) {
  std::set<int> lines{line};
  const chain::StrandLine& all = strands.lines()[line];
  for (const auto* strand : {&all.first, &all.second})
    for (std::size_t k = 1; k + 1 < strand->size(); ++k)
      for (const int link : {(*strand)[k] - 1, (*strand)[k]})
        if (const int other = link < (*strand)[k] ? link : link + 1;
            strands.welded(link) && strands.line_of(other) >= 0)
          lines.insert(strands.line_of(other));
  double most = 0.0;
  for (const int one : lines) most = std::max(most, nearer_between(profile, strands, one));
  return most;
}

}  // namespace

ContactEvent spare_touches(const Profile& profile, const chain::Strands& strands, int i, int line) {
  ContactEvent event{ContactEvent::Kind::length, i, 1.0, profile.pieces[i].s(0)};
  event.redrawn = true;
  const chain::StrandLine& all = strands.lines()[line];
  if (i == all.first.front() || i == std::min(all.second.front(), all.second.back()))
    event.value =
        nearer_at_same_places(profile, strands, line) / (spare_between_strands * carried_between_strands) -
        1.0;
  return event;
}

namespace {

/// The touch at the place of a joint that is of the line which ends at another, and pressed on; −1: none.
int pressed_before_end(const chain::Strands& strands, int at, int end) {
  const int line = strands.line_of(end);
  if (line < 0 || strands.inside_line(end) || strands.partner(at) < 0) return -1;
  for (int j = at - 1; j >= 0 && strands.welded(j); --j)
    if (strands.pressed(j) && strands.line_of(j) == line) return j;
  for (int j = at + 1; strands.welded(j - 1); ++j)
    if (strands.pressed(j) && strands.line_of(j) == line) return j;
  return -1;
}

/// Inside a line of free strands with their own image, where tangency says.
bool found_by_tangency(const chain::Strands& strands, int joint) {
  if (!strands.inside_line(joint) || strands.laid(joint)) return false;
  const chain::StrandLine& line = strands.lines()[strands.line_of(joint)];
  return line.own_image() && !line.on_obstacles;
}

}  // namespace

std::optional<LaidAnew> laid_anew_at(const Profile& profile, const chain::Strands& strands, int link) {
  const auto [begin, end] = strands.located_about(link, link + 1);
  int parts = 0;
  for (int i = begin; i < end; ++i) parts += !strands.welded(i);
  for (const auto& [at, line_end] : {std::pair(begin, end), std::pair(end, begin)})
    if (const int pressed = pressed_before_end(strands, at, line_end); pressed >= 0)
      return LaidAnew{begin, end, std::max(press_at_end, parts * laid_too_near), -1, pressed, line_end};
  // An edge comes near the middle of a line, or a touch beyond it, whichever is nearer.
  std::optional<LaidAnew> out;
  const auto left = [&](const LaidAnew& to) {
    return profile.pieces[to.end].s(0) - profile.pieces[to.begin].s(0) - to.least * profile.unit_length;
  };
  const auto offer = [&](const LaidAnew& anew) {
    if (!out || left(anew) < left(*out)) out = anew;
  };
  for (const auto& [at, other] : {std::pair(begin, end), std::pair(end, begin)})
    if (found_by_tangency(strands, at) && strands.line_of(other) != strands.line_of(at))
      offer({begin, end, at_middle, at});
  for (const auto& [at, other] : {std::pair(link, link + 1), std::pair(link + 1, link)})
    if (found_by_tangency(strands, at) && !strands.inside_line(other) &&
        strands.line_of(other) != strands.line_of(at))
      offer({link, link + 1, at_touch});
  const int laid = strands.laid(link) ? link : strands.laid(link + 1) ? link + 1 : -1;
  if (parts > 1 && laid >= 0 && !strands.lines()[strands.line_of(laid)].on_obstacles)
    offer({begin, end, parts * laid_too_near});
  return out;
}

std::optional<ContactEvent> laid_between(const Profile& profile, const chain::Strands& strands, int link) {
  const std::optional<LaidAnew> anew = laid_anew_at(profile, strands, link);
  if (!strands.laid(link) && !strands.laid(link + 1) && !anew) return std::nullopt;
  const auto keeps = [&](int joint) { return strands.laid(joint) || !strands.inside_line(joint); };
  if (!anew && (!keeps(link) || !keeps(link + 1)))
    return std::nullopt;  // located by tangency: it may meet the other
  const auto [first, last] = strands.located_about(link, link + 1);
  const int begin = anew ? anew->begin : first, end = anew ? anew->end : last;
  ContactEvent event{ContactEvent::Kind::length, link, 1.0, profile.pieces[link].s(0)};
  event.redrawn = anew.has_value();
  const int named = line_of_several(strands, end - 1) < 0 ? end - 1 : begin;
  if (link == named)
    event.value = profile.pieces[end].s(0) - profile.pieces[begin].s(0) -
                  (anew ? anew->least : least_beside_strand) * profile.unit_length;
  return event;
}

namespace {

/// The one of a line's two strands that a joint is a touch of.
const std::vector<int>& strand_of(const chain::StrandLine& line, int joint) {
  const bool first = std::find(line.first.begin(), line.first.end(), joint) != line.first.end();
  return first ? line.first : line.second;
}

}  // namespace

Suction suction_about(const Profile& profile, const chain::Strands& strands, int joint) {
  const chain::StrandLine& line = strands.lines()[strands.line_of(joint)];
  const std::vector<int>& strand = strand_of(line, joint);
  std::map<int, double> force;
  for (const Contact& c : profile.contacts)
    if (c.coupling >= 0) force[c.joint] = c.force;
  const auto place = [&](int k) { return profile.pieces[strand[k]].s(0); };
  const auto pressure = [&](int k) {  // an end's force stands for half a link
    if (strands.inside_line(strand[k])) return force.at(strand[k]) / span_of(profile, strands, strand[k]);
    return force.at(strand[k]) / (0.5 * std::abs(place(k) - place(k == 0 ? 1 : k - 1)));
  };
  Suction out;
  out.first = out.last = static_cast<int>(std::find(strand.begin(), strand.end(), joint) - strand.begin());
  while (out.first > 1 && force.at(strand[out.first - 1]) < 0.0) --out.first;
  while (out.last + 1 < line.links() && force.at(strand[out.last + 1]) < 0.0) ++out.last;
  const auto zero = [&](int pulls, int beyond) {
    const double p = pressure(pulls), q = std::max(pressure(beyond), 0.0);
    return place(pulls) + (place(beyond) - place(pulls)) * p / (p - q);
  };
  for (int k = out.first; k <= out.last; ++k) out.force += force.at(strand[k]);
  out.begin = zero(out.first, out.first - 1), out.end = zero(out.last, out.last + 1);
  return out;
}

namespace {

/// How far apart touches that pull may open strands, so far from a line's end [ρ].
double opened_so_far(const Profile& profile, double from_end) {
  const double part = std::clamp((from_end / profile.unit_length - beside_end) / beside_end, 0.0, 1.0);
  return opened_at_end + part * (opened_between_strands - opened_at_end);
}

/// The end of a line on a strand that is not this joint.
int other_end(const chain::Strands& strands, int end) {
  const chain::StrandLine& line = strands.lines()[strands.line_of(end)];
  for (const auto* strand : {&line.first, &line.second}) {
    if (strand->front() == end) return strand->back();
    if (strand->back() == end) return strand->front();
  }
  return end;
}

/// From the end of a line to its next touch.
double to_next(const Profile& profile, const chain::Strands& strands, int end) {
  const chain::StrandLine& line = strands.lines()[strands.line_of(end)];
  for (const auto* strand : {&line.first, &line.second}) {
    const std::size_t last = strand->size() - 1;
    if (strand->front() == end || strand->back() == end)
      return std::abs(profile.pieces[end].s(0) -
                      profile.pieces[(*strand)[strand->front() == end ? 1 : last - 1]].s(0));
  }
  return 0.0;
}

}  // namespace

std::optional<double> part_of_opened(const Profile& profile, const chain::Strands& strands, int link) {
  constexpr double closes = 0.1, as_a_row = 0.35, spacings = 3.0;
  const auto is_end = [&](int joint) {
    const int line = strands.line_of(joint);
    return line >= 0 && !strands.inside_line(joint) && !strands.lines()[line].on_obstacles &&
           !strands.lines()[line].own_image();
  };
  for (const chain::Strands::Facing& f : strands.facing(link)) {
    if (f.line >= 0 || f.begin != link || f.end != link + 1 || std::abs(f.other_end - f.other_begin) != 1 ||
        !is_end(f.begin) || !is_end(f.end))
      continue;
    const Contact &before = *profile.contact_at(f.begin), &after = *profile.contact_at(f.end);
    const double width = profile.pieces[link].length(),
                 other = std::abs(profile.contact_at(f.other_end)->s - profile.contact_at(f.other_begin)->s);
    const double force = std::max(0.5 * (before.force + after.force), 0.0);
    const double height =
        force * (std::pow(width, 3) + std::pow(other, 3)) / (384.0 * profile.material.bending_stiffness);
    const double from_end = std::min(std::abs(before.s - profile.contact_at(other_end(strands, f.begin))->s),
                                     std::abs(after.s - profile.contact_at(other_end(strands, f.end))->s));
    const double opened = std::pow(height / opened_so_far(profile, from_end), 1.0 / 6.0);
    const double apart = 0.5 * (to_next(profile, strands, f.begin) + to_next(profile, strands, f.end));
    return std::min(opened / std::pow(closes, 1.0 / 6.0),
                    std::max(opened / std::pow(as_a_row, 1.0 / 6.0), width / (spacings * apart)));
  }
  return std::nullopt;
}

double carried_pull(const Profile& profile, const chain::Strands& strands, const Contact& contact) {
  const int joint = contact.joint;
  if (!strands.inside_line(joint)) return 0.0;
  const double h = span_of(profile, strands, joint), stiffness = profile.material.bending_stiffness;
  const chain::StrandLine& line = strands.lines()[strands.line_of(joint)];
  const std::vector<int>& strand = strand_of(line, joint);
  const auto to = [&](int end) { return std::abs(profile.pieces[joint].s(0) - profile.pieces[end].s(0)); };
  const double opened = opened_so_far(profile, std::min(to(strand.front()), to(strand.back())));
  const double alone = 12.0 * opened * stiffness / (h * h * h);
  if (contact.force >= 0.0) return alone;
  const Suction pull = suction_about(profile, strands, joint);
  const double together = 15.36 * opened * stiffness / std::pow(pull.width(), 3);
  return std::min(alone, together) + pull.force - contact.force;
}

}  // namespace windlass::equilibrium
