#include "plate_successors.hpp"

#include <optional>
#include <utility>

namespace windlass::equilibrium {

using chain::Profile;
using chain::Stretch;

std::vector<Successor> flat_line_lifts(int link, const Strip& strip, const Profile& profile) {
  constexpr double unpressed = 1e-6;
  const auto flat = [&](int i) {
    return strip.is_line(i) && strip.on[i].flat >= 0 && profile.pieces[i].p.maxCoeff() < unpressed;
  };
  const int i = flat(link) ? link : flat(link - 1) ? link - 1 : link + 1;
  std::vector<Successor> out;
  if (!flat(i) || (!strip.is_line(i - 1) && !strip.is_line(i + 1))) return out;
  const chain::Seat plate{strip.on[i].flat}, cylinder{strip.on[i].obstacle};
  // Of p = a + b σ², σ from the place where it leaves the plate: lengths grow with the root of what is beyond the event, so that a
  // state beside it is sought.
  for (const double length : {0.2, 0.1, 0.3}) {
    const double gap = length * profile.unit_length;
    Strip next = strip;
    next.parts[i].kind = Stretch::gap;
    next.on[i].flat = -1;
    if (strip.is_line(i + 1)) {
      next.split(i + 1, strip.s[i + 1] + gap, Stretch::gap, Stretch::line, cylinder);
      next.on[i + 1] = plate;
    } else {
      next.on[i + 1].flat = plate.obstacle;
    }
    if (strip.is_line(i - 1)) {
      next.split(i - 1, strip.s[i] - gap, Stretch::line, Stretch::gap, cylinder);
      next.on[i + 1] = plate;
    } else {
      next.on[i].flat = plate.obstacle;
    }
    out.push_back(next.successor());
  }
  return out;
}

namespace {

/// An arc that vanishes before a stretch that lies in a plate, seen from the contacts on its other side.
struct Meeting {
  const Profile& profile;
  const Strip& strip;
  int link;
  bool rightward;  ///< the way from the contacts into the plate
  int line() const { return rightward ? link - 1 : link + 1; }
  int tail() const { return rightward ? link + 1 : link - 1; }  ///< what lies in the plate
  int inner() const { return rightward ? link : link + 1; }
  int outer() const { return rightward ? link + 1 : link; }
  int far() const { return rightward ? link + 2 : link - 1; }  ///< joint at the other end of `tail`
  double beyond(int joint, double length) const {
    return strip.s[joint] + (rightward ? length : -length) * profile.unit_length;
  }
  bool on_plate(int joint) const {
    const int obstacle = strip.on[joint].obstacle;
    return strip.on[joint].strand == 0 && obstacle > 0 && profile.obstacles[obstacle].curvature() == 0.0 &&
           profile.obstacles[0].slips();
  }
  /// A line on the plate alone presses at its ends only: a free stretch that lies in it.
  bool line_on_plate() const { return strip.is_line(tail()) && on_plate(tail()); }
  bool lies_flat() const {
    return line_on_plate() || (!strip.is_line(tail()) && (strip.parts[tail()].kind == Stretch::tail ||
                                                          strip.plate_beside(tail()) >= 0));
  }
};

/// A touch of the cylinder, or of another strand, and one of the plate change places.
std::vector<Successor> change_places(const Meeting& at) {
  const Strip& strip = at.strip;
  const int inner = at.inner(), outer = at.outer();
  const bool flat = strip.on[outer].flat >= 0;
  const chain::Seat& other = strip.on[flat ? outer : inner];
  if (!at.on_plate(flat ? inner : outer) || other.line != 0 || (!flat && other.flat >= 0) ||
      (other.strand == 0 && other.obstacle != 0))
    return {};
  Strip next = strip;
  next.parts[at.link].fresh = true;
  std::swap(next.on[inner], next.on[outer]);
  const int held = strip.on[flat ? inner : outer].obstacle;
  chain::Seat& moved = next.on[flat ? inner : outer];
  moved.flat = flat ? -1 : held;
  if (moved.strand != 0) moved.obstacle = flat ? 0 : held;
  if (at.line_on_plate()) next.parts[at.tail()].kind = Stretch::gap;
  const bool between_touches = strip.parts[at.tail()].kind == Stretch::gap && at.on_plate(at.far());
  if (flat && between_touches) next.parts[at.tail()].kind = Stretch::line;
  std::vector<Successor> out;
  next.s[outer] = at.beyond(inner, 0.05);
  out.push_back(next.successor());
  // What is hardly bent over the cylinder stays where it is.
  const int before = flat ? outer : inner, after = flat ? inner : outer;
  for (const double length : {1e-2, 1e-3}) {
    next.s[after] = strip.s[before];
    next.s[before] = at.beyond(before, flat ? length : -length);
    out.push_back(next.successor());
  }
  return out;
}

/// Does a stretch that lies in the plate lie on the cylinder, too, but for rounding?
bool on_cylinder(const Meeting& at) {
  constexpr double nothing = 1e-6;
  const chain::Piece& piece = at.profile.pieces[at.strip.parts[at.tail()].source];
  double widest = 0.0;
  for (Eigen::Index k = 0; k < piece.s.size(); ++k)
    widest = std::max(widest, at.profile.obstacles[0].gap(piece.r.col(k)));
  return widest < nothing * at.profile.unit_length;
}

/// Where a line has drawn back from the place at which it left the plate (flat_line_lifts), and comes there again: what lies flat
/// beside it, along the cylinder without pressure, is a line on both.
std::optional<Successor> flat_line_closes(const Meeting& at) {
  const Strip& strip = at.strip;
  const chain::Seat& end = strip.on[at.far()];
  if (strip.parts[at.tail()].kind != Stretch::gap || end.obstacle != 0 || end.strand != 0 || end.flat < 0 ||
      !on_cylinder(at))
    return std::nullopt;
  Strip next = strip;
  const int flat = at.rightward ? at.inner() : at.far();
  next.parts[at.tail()].kind = Stretch::line;
  next.on[at.inner()] = next.on[at.outer()] = next.on[at.far()] = chain::Seat{0};
  next.erase(at.link, at.inner());
  next.on[flat].flat = end.flat;
  return next.successor();
}

/// With the arc between two joints of several lengths. @param way  from the one into the plate, 1, or out of it, -1
std::vector<Successor> of_lengths(Strip next, const Meeting& at, int joint, int from, double way) {
  std::vector<Successor> out;
  for (const double length : {0.05, 1e-2, 2e-3}) {
    next.s[joint] = at.beyond(from, way * length);
    out.push_back(next.successor());
  }
  return out;
}

/// The line of the cylinder reaches the plate and lies on both from there on, or the other way round.
std::vector<Successor> line_reaches_or_leaves(const Meeting& at) {
  const Strip& strip = at.strip;
  const int link = at.link;
  if (at.strip.parts[link].kind == Stretch::gap && at.on_plate(at.outer()))
    if (const auto closed = flat_line_closes(at)) return {*closed};
  Strip next = strip;
  next.parts[link].fresh = true;
  const int cylinder = strip.on[at.line()].obstacle;
  if (strip.parts[link].kind == Stretch::gap && at.on_plate(at.outer())) {
    const int plate = strip.on[at.outer()].obstacle;
    next.parts[link].kind = Stretch::line;
    if (at.line_on_plate()) next.parts[at.tail()].kind = Stretch::gap;
    next.on[link] = next.on[link + 1] = chain::Seat{cylinder};
    next.on[link].flat = plate;
    return of_lengths(next, at, at.outer(), at.inner(), 1.0);
  }
  if (strip.is_line(link) && strip.on[link].flat >= 0 && strip.on[at.line()].flat < 0) {
    const chain::Seat plate{strip.on[link].flat};
    next.parts[link].kind = Stretch::gap;
    const bool between_touches = strip.parts[at.tail()].kind == Stretch::gap && at.on_plate(at.far());
    if (between_touches) next.parts[at.tail()].kind = Stretch::line;
    next.on[at.inner()] = chain::Seat{cylinder};
    next.on[at.outer()] = plate;
    return of_lengths(next, at, at.outer(), at.inner(), 1.0);
  }
  return {};
}

/// Beside a line on cylinder and plate its end on the one meets its end on the other: what is between, a line of the cylinder or a
/// free stretch in the plate, gives way to its like.
std::vector<Successor> ends_change_places(const Meeting& at) {
  const Strip& strip = at.strip;
  const int link = at.link, flat = at.tail();
  if (!strip.is_line(flat) || strip.on[flat].flat < 0 || strip.is_line(at.line()) ||
      (strip.is_line(link) && strip.on[link].flat >= 0) || strip.on[at.inner()].strand != 0 ||
      strip.on[at.outer()].strand != 0)
    return {};
  const bool line = strip.is_line(link);
  if (!line && !at.on_plate(at.inner())) return {};
  const chain::Seat cylinder{strip.on[flat].obstacle}, plate{strip.on[flat].flat};
  Strip next = strip;
  next.parts[link] = {line ? Stretch::gap : Stretch::line, next.parts[link].source, true};
  next.on[at.inner()] = line ? plate : cylinder;
  std::vector<Successor> out = of_lengths(next, at, at.inner(), at.outer(), -1.0);
  for (Successor& one : out) one.beside = true;
  return out;
}

}  // namespace

std::vector<Successor> flat_line_begins_or_ends(int link, const Profile& profile, const Strip& strip) {
  const int last = static_cast<int>(strip.parts.size()) - 1;
  if (strip.half || link < 1 || link >= last) return {};
  for (const bool rightward : {true, false}) {
    const Meeting at{profile, strip, link, rightward};
    if (const auto changed = ends_change_places(at); !changed.empty()) return changed;
    if (!at.lies_flat()) continue;
    std::vector<Successor> out;
    if (strip.is_line(at.line()))
      out = line_reaches_or_leaves(at);
    else if (!strip.is_line(link))
      out = change_places(at);
    if (!out.empty()) return out;
  }
  return {};
}

}  // namespace windlass::equilibrium
