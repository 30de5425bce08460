#include "strip.hpp"

#include <algorithm>

namespace windlass::equilibrium {

using chain::Stretch;

Strip::Strip(const chain::Topology& topology, const std::vector<double>& places)
    : s(places), half(topology.half), mid_touch(topology.mid_touch), symmetry(topology.symmetry) {
  for (int j = 0; j < static_cast<int>(s.size()); ++j) on.push_back(topology.seat(j));
  for (const Stretch kind : topology.stretches) parts.push_back({kind, static_cast<int>(parts.size())});
}

Strip::Strip(const Successor& next) : Strip(next.topology, next.s) {
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].source = next.source[i];
  for (const int link : next.opened) parts[link].fresh = true;
}

Successor Strip::successor() const {
  Successor out;
  out.s = s;
  out.topology.half = half;
  out.topology.mid_touch = mid_touch;
  out.topology.symmetry = symmetry;
  std::vector<chain::Seat> contacts =
      on;  // the ends touch nothing but plates; nor does a section of a half chain
  if (half ? !mid_touch && parts.front().kind != Stretch::line : contacts.front().obstacle <= 0)
    contacts.front() = {};
  if (contacts.back().obstacle <= 0) contacts.back() = {};
  for (int j = 1; j < static_cast<int>(parts.size()); ++j)
    if (is_line(j - 1) && !is_line(j))
      contacts[j].flat = -1;  // of a line its beginning says that it lies flat
  if (std::any_of(contacts.begin(), contacts.end(),
                  [](const chain::Seat& seat) { return seat != chain::Seat{}; }))
    out.topology.on = contacts;
  for (const Part& part : parts) {
    if (part.fresh) out.opened.push_back(static_cast<int>(out.topology.stretches.size()));
    out.topology.stretches.push_back(part.kind);
    out.source.push_back(part.source);
  }
  out.nothing_left = !out.topology.contact();
  return out;
}

void Strip::erase(int i, int bound) {
  parts.erase(parts.begin() + i);
  s.erase(s.begin() + bound);
  on.erase(on.begin() + bound);
}

void Strip::merge(int first, int last, Stretch kind) {
  for (int i = last; i > first; --i) erase(i, i);
  parts[first].kind = kind;
  if (kind != Stretch::line || !starts_at_mid(first)) return;
  if (!mid_touch) {
    on[0] = on[1];  // a section of it is there now, which no strand touches
    on[0].strand = on[0].line = on[0].shares = 0;
    on[0].part = 0.0;
  }
  mid_touch = mid_touch && on[0].strand != 0;  // a touch of the line's own obstacle is part of it
}

void Strip::split(int i, double at, Stretch left, Stretch right, std::optional<chain::Seat> contact) {
  const Part old = parts[i];
  parts[i].kind = left;
  parts.insert(parts.begin() + i + 1, {right, old.source});
  s.insert(s.begin() + i + 1, at);
  on.insert(on.begin() + i + 1, contact.value_or(chain::Seat{on[i].obstacle}));
}

int Strip::part_at(double at) const {
  int i = 0;
  while (i + 1 < static_cast<int>(parts.size()) && at > s[i + 1]) ++i;
  return i;
}

int Strip::plate_beside(int i) const {
  int plate = -1;
  for (const int joint : {i, i + 1}) {
    const bool before = is_line(joint - 1), after = is_line(joint);
    if (before && after) continue;
    plate = std::max(plate, before ? on[joint - 1].flat : on[joint].flat);  // of a line its beginning says so
  }
  return plate;
}

void Strip::cut(int i, double at, chain::Seat contact) {
  if (parts[i].kind == Stretch::line) {
    contact.obstacle = on[i].obstacle, contact.flat = on[i].flat;
    return split(i, at, Stretch::line, Stretch::line, contact);
  }
  if (const int plate = plate_beside(i); contact.strand != 0 && plate >= 0)
    contact.obstacle = contact.flat = plate;
  const bool left_tail = !half && i == 0, alone = parts.size() == 1;
  const bool right_tail = parts[i].kind == Stretch::tail && (!left_tail || alone);
  split(i, at, left_tail ? Stretch::tail : Stretch::gap, right_tail ? Stretch::tail : Stretch::gap, contact);
}

bool Strip::collapse(int i) {
  if (starts_at_mid(i)) {
    if (!mid_touch) return collapse_about_mid();
    erase(i, i + 1);  // a touch meets the one at the mid-point
    mid_touch = parts[i].kind != Stretch::line;
    return true;
  }
  if (i == 0 || i + 1 == static_cast<int>(parts.size())) return false;
  const bool line_before = parts[i - 1].kind == Stretch::line,
             line_after = parts[i + 1].kind == Stretch::line;
  if (line_before && line_after && parts[i].kind != Stretch::line) {
    merge(i - 1, i + 1, Stretch::line);
    return true;
  }
  if (parts[i].kind == Stretch::line ||
      (!line_before && !line_after))  // two edges or two touches meet: one touch
    s[i] = 0.5 * (s[i] + s[i + 1]);
  else if (line_before)  // line – gap – touch: the touch joins the line
    s[i] = s[i + 1];
  erase(i, i + 1);
  return true;
}

bool Strip::collapse_about_mid() {
  erase(0, 1);
  // Between lines a gap has closed; else a line, or a gap between touches, leaves one touch.
  mid_touch = parts[0].kind != Stretch::line;
  return true;
}

Stretch joined(Stretch a, Stretch b) {
  if (a == Stretch::line) return b;
  return a == Stretch::tail || b == Stretch::tail ? Stretch::tail : Stretch::gap;
}

}  // namespace windlass::equilibrium
