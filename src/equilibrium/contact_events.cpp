#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// Value of an event that is nowhere near: no local minimum of the gap, say.
constexpr double far = 1.0;

/// Least local minimum of the gap inside a free arc, by a parabola through three samples. Next to a contact the gap is
/// flat and its samples are rounding; a minimum must stand out by more than that.
ContactEvent graze(const Piece& piece, int link, bool starts_at_mid) {
  constexpr double noise = 1e-11;
  ContactEvent event{Kind::graze, link, far, piece.s(0)};
  const Eigen::Index count = piece.s.size();
  Eigen::VectorXd g(count);
  for (Eigen::Index k = 0; k < count; ++k) g(k) = chain::gap(piece.r.col(k));
  if (starts_at_mid && g(0) < g(1)) event = {Kind::graze, link, g(0), piece.s(0)};
  for (Eigen::Index k = 1; k + 1 < count; ++k) {
    if (g(k) > g(k - 1) - noise || g(k) > g(k + 1)) continue;
    const double a = piece.s(k) - piece.s(k - 1), b = piece.s(k + 1) - piece.s(k);
    const double left = (g(k) - g(k - 1)) / a, right = (g(k + 1) - g(k)) / b;
    const double curve = (right - left) / (a + b), slope = (left * b + right * a) / (a + b);
    const double shift = curve > 0.0 ? std::clamp(-0.5 * slope / curve, -a, b) : 0.0;
    const double value = g(k) + slope * shift + curve * shift * shift;
    if (value < event.value) event = {Kind::graze, link, value, piece.s(k) + shift};
  }
  return event;
}

ContactEvent least_pressure(const Piece& piece, int link) {
  Eigen::Index k = 0;
  const double value = piece.p.minCoeff(&k);
  return {Kind::pressure, link, value, piece.s(k)};
}

}  // namespace

std::string ContactEvent::name() const {
  static const char* const words[] = {"pressure", "length", "force", "curvature", "graze"};
  return std::string(words[static_cast<int>(kind)]) + " " + std::to_string(place);
}

std::vector<ContactEvent> contact_events(const Profile& profile, const Topology& topology) {
  std::vector<ContactEvent> events;
  const int count = static_cast<int>(profile.pieces.size());
  for (int i = 0; i < count; ++i) {
    const Piece& piece = profile.pieces[i];
    const double length = piece.s(piece.s.size() - 1) - piece.s(0);
    const bool at_mid = topology.half && i == 0;
    if (piece.stretch == Stretch::line) events.push_back(least_pressure(piece, i));
    if (piece.stretch != Stretch::tail) events.push_back({Kind::length, i, length, piece.s(0)});
    if (piece.stretch != Stretch::line) events.push_back(graze(piece, i, at_mid && !topology.mid_touch));
  }
  for (const Contact& c : profile.contacts) {
    events.push_back({Kind::force, c.joint, c.force, c.s});
    if (!c.edge) events.push_back({Kind::curvature, c.joint, c.gap_curvature, c.s});
  }
  return events;
}

namespace {

/// The chain's arcs with their bounds: easier to cut and join than topologies.
struct Strip {
  std::vector<Stretch> kinds;
  std::vector<double> s;
  std::vector<int> source;
  bool half = true, mid_touch = false;
  int marker = 0;  ///< joint of the mid-point (full chains)
};

Strip strip_of(const Topology& t, const std::vector<double>& s) {
  Strip strip{chain::stretches(t), s, {}, t.half, t.mid_touch, static_cast<int>(t.left.size())};
  for (std::size_t i = 0; i < strip.kinds.size(); ++i) strip.source.push_back(static_cast<int>(i));
  return strip;
}

Successor successor_of(const Strip& strip) {
  Successor out;
  out.s = strip.s;
  out.source = strip.source;
  out.topology.half = strip.half;
  out.topology.mid_touch = strip.mid_touch;
  const int first = strip.half ? 0 : strip.marker;
  out.topology.right.assign(strip.kinds.begin() + first, strip.kinds.end());
  out.topology.left.assign(strip.kinds.rend() - first, strip.kinds.rend());
  if (strip.half) out.topology.left.clear();
  out.nothing_left = !out.topology.contact();
  return out;
}

/// Replaces arcs [first, last] of the strip by one arc.
void merge(Strip& strip, int first, int last, Stretch kind) {
  strip.kinds.erase(strip.kinds.begin() + first + 1, strip.kinds.begin() + last + 1);
  strip.source.erase(strip.source.begin() + first + 1, strip.source.begin() + last + 1);
  strip.s.erase(strip.s.begin() + first + 1, strip.s.begin() + last + 1);
  strip.kinds[first] = kind;
  if (strip.marker > last) strip.marker -= last - first;
}

/// Splits arc i at s into (i, kind_left) and (i + 1, kind_right).
void split(Strip& strip, int i, double s, Stretch left, Stretch right) {
  strip.kinds[i] = left;
  strip.kinds.insert(strip.kinds.begin() + i + 1, right);
  strip.source.insert(strip.source.begin() + i + 1, strip.source[i]);
  strip.s.insert(strip.s.begin() + i + 1, s);
  if (!strip.half && strip.marker > i) ++strip.marker;
}

/// Free arcs left and right of what was lost become one: a tail if either is.
Stretch joined(Stretch a, Stretch b) {
  return a == Stretch::tail || b == Stretch::tail ? Stretch::tail : Stretch::gap;
}

std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip, const Piece& line) {
  std::vector<Successor> out;
  const int i = event.place;
  const double begin = strip.s[i], end = strip.s[i + 1], length = end - begin;
  const bool at_mid = strip.half && i == 0;
  Strip open = strip;  // the whole line lifts at once, on both sides of a full chain's mid-point
  open.kinds[i] = Stretch::gap;
  const int twin = strip.half ? i : i == strip.marker ? i - 1 : i + 1 == strip.marker ? i + 1 : i;
  open.kinds[twin] = Stretch::gap;
  const bool uniform = line.p.maxCoeff() < 1e-6;
  if (uniform) out.push_back(successor_of(open));
  // Pressure lost at an edge, whose point force stays: the force becomes a touch, with a gap between it and the line.
  const bool at_start = event.s < begin + 0.02 * length && i > 0 && !(!strip.half && i == strip.marker);
  const bool at_end = event.s > end - 0.02 * length && !(!strip.half && i + 1 == strip.marker);
  for (const double part : {0.08, 0.04, 0.02}) {
    Strip detached = strip;
    if (at_end && !uniform) {
      split(detached, i, end - part * length, Stretch::line, Stretch::gap);
      out.push_back(successor_of(detached));
    } else if (at_start && !uniform) {
      split(detached, i, begin + part * length, Stretch::gap, Stretch::line);
      out.push_back(successor_of(detached));
    }
  }
  for (const double size :
       {0.5, 0.3, 0.8}) {  // an opening grows like the square root: not small a little beyond
    const double part = size / length;
    if (part > 0.9) continue;
    Strip inner = strip;
    if (at_mid && event.s < begin + 0.02 * length) {
      split(inner, i, begin + part * length, Stretch::gap, Stretch::line);
    } else if (twin != i && std::abs(event.s) < 0.02 * length) {
      const int left = strip.marker - 1;
      split(inner, left + 1, strip.s[left + 1] + part * length, Stretch::gap, Stretch::line);
      split(inner, left, strip.s[left + 1] - part * length, Stretch::line, Stretch::gap);
    } else {
      const double half_gap = std::min(size, 0.8 * std::min(event.s - begin, end - event.s));
      if (half_gap < 1e-3 * length) break;
      split(inner, i, event.s - half_gap, Stretch::line, Stretch::gap);
      split(inner, i + 1, event.s + half_gap, Stretch::gap, Stretch::line);
    }
    out.push_back(successor_of(inner));
  }
  if (!uniform) out.push_back(successor_of(open));
  return out;
}

std::vector<Successor> after_length(const ContactEvent& event, Strip strip) {
  const int i = event.place;
  const bool line = strip.kinds[i] == Stretch::line;
  std::vector<Successor> out;
  if (strip.half && i == 0) {  // a line or gap about the mid-point shrinks to a touch there
    strip.kinds.erase(strip.kinds.begin());
    strip.source.erase(strip.source.begin());
    strip.s.erase(strip.s.begin());
    strip.s[0] = 0.0;
    if (strip.kinds.front() == Stretch::line) {  // a gap closed inside a line
      out.push_back(successor_of(strip));
      return out;
    }
    strip.mid_touch = true;
    out.push_back(successor_of(strip));
    return out;
  }
  if (i == 0 || i + 1 == static_cast<int>(strip.kinds.size())) return out;
  const Stretch before = strip.kinds[i - 1], after = strip.kinds[i + 1];
  const double middle = 0.5 * (strip.s[i] + strip.s[i + 1]);
  if (line || (before != Stretch::line && after != Stretch::line)) {
    // free – line – free, or two touches meeting: one touch between the neighbours.
    strip.s[i] = middle;
    strip.kinds.erase(strip.kinds.begin() + i);
    strip.source.erase(strip.source.begin() + i);
    strip.s.erase(strip.s.begin() + i + 1);
    if (strip.marker > i) --strip.marker;
    out.push_back(successor_of(strip));
  } else if (before == Stretch::line && after == Stretch::line) {
    merge(strip, i - 1, i + 1, Stretch::line);
    out.push_back(successor_of(strip));
  } else {  // line – gap – touch: the touch joins the line
    if (before == Stretch::line) strip.s[i] = strip.s[i + 1];
    strip.kinds.erase(strip.kinds.begin() + i);
    strip.source.erase(strip.source.begin() + i);
    strip.s.erase(strip.s.begin() + i + 1);
    if (strip.marker > i) --strip.marker;
    out.push_back(successor_of(strip));
  }
  return out;
}

std::vector<Successor> after_force(const ContactEvent& event, Strip strip) {
  const int j = event.place;
  if (strip.half && j == 0) {  // the touch at the mid-point opens
    strip.mid_touch = false;
    if (strip.kinds.front() == Stretch::tail && strip.kinds.size() > 1) strip.kinds.front() = Stretch::gap;
    return {successor_of(strip)};
  }
  const Stretch before = strip.kinds[j - 1], after = strip.kinds[j];
  if (before == Stretch::line || after == Stretch::line) return {};
  merge(strip, j - 1, j, joined(before, after));
  return {successor_of(strip)};
}

std::vector<Successor> after_curvature(const ContactEvent& event, const Strip& strip,
                                       const Profile& profile) {
  std::vector<Successor> out;
  const int j = event.place;
  // A neighbouring gap that lies on the cylinder all along closes as a whole.
  for (const int i : {j - 1, j}) {
    if (i < 0 || strip.kinds[i] != Stretch::gap) continue;
    double widest = 0.0;
    for (Eigen::Index k = 0; k < profile.pieces[i].s.size(); ++k)
      widest = std::max(widest, std::abs(chain::gap(profile.pieces[i].r.col(k))));
    if (widest > 1e-5) continue;
    Strip closed = strip;
    closed.kinds[i] = Stretch::line;
    out.push_back(successor_of(closed));
  }
  for (const double length : {1e-3, 1e-2}) {
    Strip flat = strip;
    if (strip.half && j == 0) {
      split(flat, 0, length, Stretch::line, strip.kinds.front());
      flat.mid_touch = false;
    } else {
      split(flat, j, strip.s[j] + length, Stretch::line, strip.kinds[j]);
      flat.s[j] -= length;
    }
    out.push_back(successor_of(flat));
  }
  return out;
}

std::vector<Successor> after_graze(const ContactEvent& event, Strip strip) {
  const int i = event.place;
  if (strip.half && i == 0 && event.s < 1e-9) {
    strip.mid_touch = true;
    return {successor_of(strip)};
  }
  const Stretch kind = strip.kinds[i];
  const bool left_tail = !strip.half && i == 0, right_tail = kind == Stretch::tail && !left_tail;
  split(strip, i, event.s, left_tail ? Stretch::tail : Stretch::gap,
        right_tail ? Stretch::tail : Stretch::gap);
  return {successor_of(strip)};
}

}  // namespace

std::vector<Successor> successors(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                  const std::vector<double>& s) {
  const Strip strip = strip_of(topology, s);
  switch (event.kind) {
    case Kind::pressure: {
      // A line that shrinks to nothing as its pressure vanishes (phi = pi) leaves a touch.
      if (std::abs(s[event.place + 1] - s[event.place]) < 1e-4) return after_length(event, strip);
      return after_pressure(event, strip, profile.pieces[event.place]);
    }
    case Kind::length:
      return after_length(event, strip);
    case Kind::force:
      return after_force(event, strip);
    case Kind::curvature:
      return after_curvature(event, strip, profile);
    case Kind::graze:
      return after_graze(event, strip);
  }
  return {};
}

}  // namespace windlass::equilibrium
