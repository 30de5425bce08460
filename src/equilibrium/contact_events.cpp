#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <utility>

#include "windlass/bvp/collocation_table.hpp"

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

struct Least {
  double value, s;
};

/// Least value of a sampled quantity between the neighbours of sample k, on the polynomials of the elements there: an
/// event located by samples would move with the mesh.
Least least_near(const Piece& piece, const Eigen::VectorXd& values, Eigen::Index k) {
  constexpr int bits = 26;  // half of a double: a minimum is flat
  Least least{values(k), piece.s(k)};
  for (const Eigen::Index from : {k - 1, k}) {
    if (from < 0 || from + 1 >= values.size()) continue;
    const Eigen::Index first = from / piece.stride * piece.stride;
    const Eigen::VectorXd nodes = piece.s.segment(first, piece.stride + 1);
    const double begin = nodes(0), length = nodes(piece.stride) - begin;
    const Eigen::VectorXd scaled = (nodes.array() - begin) / length;
    const auto polynomial = [&](double x) {
      return bvp::lagrange_basis(scaled, x).dot(values.segment(first, piece.stride + 1));
    };
    const auto [x, value] = boost::math::tools::brent_find_minima(polynomial, scaled(from - first),
                                                                  scaled(from + 1 - first), bits);
    if (value < least.value) least = {value, begin + length * x};
  }
  return least;
}

/// Least local minimum of the gap inside a free arc. Next to a contact the gap is flat and its samples are rounding; a
/// minimum must stand out by more than that.
ContactEvent graze(const Piece& piece, int link, bool starts_at_mid) {
  constexpr double noise = 1e-11;
  ContactEvent event{Kind::graze, link, far, piece.s(0)};
  const Eigen::Index count = piece.s.size();
  Eigen::VectorXd g(count);
  for (Eigen::Index k = 0; k < count; ++k) g(k) = chain::gap(piece.r.col(k));
  if (starts_at_mid && g(0) < g(1)) event = {Kind::graze, link, g(0), piece.s(0)};
  for (Eigen::Index k = 1; k + 1 < count; ++k) {
    if (g(k) > g(k - 1) - noise || g(k) > g(k + 1)) continue;
    const Least least = least_near(piece, g, k);
    if (least.value < event.value) event = {Kind::graze, link, least.value, least.s};
  }
  return event;
}

ContactEvent least_pressure(const Piece& piece, int link) {
  Eigen::Index k = 0;
  piece.p.minCoeff(&k);
  const Least least = least_near(piece, piece.p, k);
  return {Kind::pressure, link, least.value, least.s};
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
    if (piece.stretch != Stretch::tail)
      events.push_back({Kind::length, i, length - least_length, piece.s(0)});
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
  struct Part {
    Stretch kind;
    int source;          ///< link of the old chain
    bool fresh = false;  ///< has no length at the event itself
  };
  std::vector<Part> parts;
  std::vector<double> s;  ///< bounds of the parts
  bool half = true, mid_touch = false;
  int marker = 0;  ///< joint of the mid-point (full chains)

  /// Takes out part i and its bound at `bound`.
  void erase(int i, int bound) {
    parts.erase(parts.begin() + i);
    s.erase(s.begin() + bound);
  }
};

Strip strip_of(const Topology& t, const std::vector<double>& s) {
  Strip strip{{}, s, t.half, t.mid_touch, static_cast<int>(t.left.size())};
  for (const Stretch kind : chain::stretches(t))
    strip.parts.push_back({kind, static_cast<int>(strip.parts.size())});
  return strip;
}

Successor successor_of(const Strip& strip) {
  Successor out;
  out.s = strip.s;
  std::vector<Stretch> kinds;
  for (const Strip::Part& part : strip.parts) {
    if (part.fresh) out.opened.push_back(static_cast<int>(kinds.size()));
    kinds.push_back(part.kind);
    out.source.push_back(part.source);
  }
  out.topology.half = strip.half;
  out.topology.mid_touch = strip.mid_touch;
  const int first = strip.half ? 0 : strip.marker;
  out.topology.right.assign(kinds.begin() + first, kinds.end());
  out.topology.left.assign(kinds.rend() - first, kinds.rend());
  if (strip.half) out.topology.left.clear();
  out.nothing_left = !out.topology.contact();
  return out;
}

/// Replaces arcs [first, last] of the strip by one arc.
void merge(Strip& strip, int first, int last, Stretch kind) {
  for (int i = last; i > first; --i) strip.erase(i, i);
  strip.parts[first].kind = kind;
  if (strip.marker > last) strip.marker -= last - first;
}

/// Splits arc i at s into (i, left) and (i + 1, right).
void split(Strip& strip, int i, double s, Stretch left, Stretch right) {
  const Strip::Part old = strip.parts[i];
  strip.parts[i].kind = left;
  strip.parts.insert(strip.parts.begin() + i + 1, {right, old.source});
  strip.s.insert(strip.s.begin() + i + 1, s);
  if (!strip.half && strip.marker > i) ++strip.marker;
}

/// Free arcs left and right of what was lost become one: a tail if either is.
Stretch joined(Stretch a, Stretch b) {
  return a == Stretch::tail || b == Stretch::tail ? Stretch::tail : Stretch::gap;
}

/// Stretch of negative pressure round s; no length at the event itself.
std::pair<double, double> suction(const Piece& line, double s) {
  const auto edge = [&](Eigen::Index k, Eigen::Index next) {
    return line.s(k) + (line.s(next) - line.s(k)) * line.p(k) / (line.p(k) - line.p(next));
  };
  Eigen::Index k = 0;
  (line.s.array() - s).abs().minCoeff(&k);
  if (line.p(k) >= -1e-9) return {s, s};
  Eigen::Index first = k, last = k;
  const Eigen::Index end = line.s.size() - 1;
  while (first > 0 && line.p(first - 1) < 0.0) --first;
  while (last < end && line.p(last + 1) < 0.0) ++last;
  return {first > 0 ? edge(first, first - 1) : line.s(0), last < end ? edge(last, last + 1) : line.s(end)};
}

/// Lengths to try for a gap that opens where the pressure is negative over `width`. A beam held off by the pressure
/// p₀ + a x² needs √5 times that width for g = g' = g'' = 0 at its ends, one held at a touch 5/3 of it; at the event
/// itself the width is nothing, and the load gives way to any length: by its square inside, in proportion at an edge.
std::vector<double> gap_lengths(double width, double factor, double usual, double most) {
  std::vector<double> out;
  for (const double part : {1.0, 0.5, 2.0, 3.0})
    out.push_back(std::min(most, part * (width > 1e-6 ? factor * width : usual)));
  return out;
}

std::vector<Successor> after_pressure(const ContactEvent& event, const Strip& strip, const Piece& line) {
  std::vector<Successor> out;
  const int i = event.place;
  const double begin = strip.s[i], end = strip.s[i + 1], length = end - begin;
  const int twin = strip.half ? i : i == strip.marker ? i - 1 : i + 1 == strip.marker ? i + 1 : i;
  Strip open = strip;  // the whole line lifts at once, on both sides of a full chain's mid-point
  open.parts[i].kind = open.parts[twin].kind = Stretch::gap;
  if (line.p.maxCoeff() < 1e-6) return {successor_of(open)};
  const auto [low, high] = suction(line, event.s);
  const double width = high - low, near = 0.02 * length;
  const bool starts_at_mid = strip.half ? i == 0 : i == strip.marker;
  const bool ends_at_mid = !strip.half && i + 1 == strip.marker;
  const bool at_start = low<begin + near, at_end = high> end - near;
  const bool at_mid = (at_start && starts_at_mid) || (at_end && ends_at_mid);
  const auto cut = [&](Strip part, int link, double from, double to) {  // a gap [from, to] inside a link
    const bool before = from > part.s[link], after = to < part.s[link + 1];
    if (after) split(part, link, to, Stretch::gap, Stretch::line);
    if (before) split(part, link, from, Stretch::line, Stretch::gap);
    part.parts[link + before].fresh = true;
    return part;
  };
  if (at_mid) {
    for (const double size : gap_lengths(2.0 * width, std::sqrt(5.0), 0.3, 1.8 * length)) {
      const int right = ends_at_mid ? i + 1 : i;
      Strip inner = cut(strip, right, strip.s[right], strip.s[right] + 0.5 * size);
      if (twin != i) inner = cut(inner, right - 1, strip.s[right] - 0.5 * size, strip.s[right]);
      out.push_back(successor_of(inner));
    }
  } else if (at_start ||
             at_end) {  // the edge's point force stays: a touch, with a gap between it and the line
    for (const double size : gap_lengths(width, 5.0 / 3.0, 0.05, 0.9 * length))
      out.push_back(
          successor_of(at_end ? cut(strip, i, end - size, end) : cut(strip, i, begin, begin + size)));
  } else {
    const double middle = 0.5 * (low + high), room = 1.8 * std::min(middle - begin, end - middle);
    for (const double size : gap_lengths(width, std::sqrt(5.0), 0.3, room))
      out.push_back(successor_of(cut(strip, i, middle - 0.5 * size, middle + 0.5 * size)));
  }
  out.push_back(successor_of(open));
  return out;
}

std::vector<Successor> after_length(const ContactEvent& event, Strip strip) {
  const int i = event.place;
  const bool line = strip.parts[i].kind == Stretch::line;
  std::vector<Successor> out;
  if (strip.half && i == 0) {  // a line or gap about the mid-point shrinks to a touch there
    strip.erase(0, 0);
    strip.s[0] = 0.0;
    if (strip.parts.front().kind == Stretch::line) {  // a gap closed inside a line
      out.push_back(successor_of(strip));
      return out;
    }
    strip.mid_touch = true;
    out.push_back(successor_of(strip));
    return out;
  }
  if (i == 0 || i + 1 == static_cast<int>(strip.parts.size())) return out;
  const Stretch before = strip.parts[i - 1].kind, after = strip.parts[i + 1].kind;
  const double middle = 0.5 * (strip.s[i] + strip.s[i + 1]);
  if (line || (before != Stretch::line && after != Stretch::line)) {
    // free – line – free, or two touches meeting: one touch between the neighbours.
    strip.s[i] = middle;
    strip.erase(i, i + 1);
    if (strip.marker > i) --strip.marker;
    out.push_back(successor_of(strip));
  } else if (before == Stretch::line && after == Stretch::line) {
    merge(strip, i - 1, i + 1, Stretch::line);
    out.push_back(successor_of(strip));
  } else {  // line – gap – touch: the touch joins the line
    if (before == Stretch::line) strip.s[i] = strip.s[i + 1];
    strip.erase(i, i + 1);
    if (strip.marker > i) --strip.marker;
    out.push_back(successor_of(strip));
  }
  return out;
}

std::vector<Successor> after_force(const ContactEvent& event, Strip strip) {
  const int j = event.place;
  if (strip.half && j == 0) {  // the touch at the mid-point opens
    strip.mid_touch = false;
    if (strip.parts.front().kind == Stretch::tail && strip.parts.size() > 1)
      strip.parts.front().kind = Stretch::gap;
    return {successor_of(strip)};
  }
  const Stretch before = strip.parts[j - 1].kind, after = strip.parts[j].kind;
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
    if (i < 0 || strip.parts[i].kind != Stretch::gap) continue;
    double widest = 0.0;
    for (Eigen::Index k = 0; k < profile.pieces[i].s.size(); ++k)
      widest = std::max(widest, std::abs(chain::gap(profile.pieces[i].r.col(k))));
    if (widest > 1e-5) continue;
    Strip closed = strip;
    closed.parts[i].kind = Stretch::line;
    out.push_back(successor_of(closed));
  }
  for (const double length : {0.05, 0.02, 0.1}) {  // of the new line
    Strip flat = strip;
    if (strip.half && j == 0) {
      split(flat, 0, 0.5 * length, Stretch::line, strip.parts.front().kind);
      flat.mid_touch = false;
      flat.parts[0].fresh = true;
    } else {
      split(flat, j, strip.s[j] + 0.5 * length, Stretch::line, strip.parts[j].kind);
      flat.s[j] -= 0.5 * length;
      flat.parts[j].fresh = true;
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
  const Stretch kind = strip.parts[i].kind;
  const bool left_tail = !strip.half && i == 0, right_tail = kind == Stretch::tail && !left_tail;
  split(strip, i, event.s, left_tail ? Stretch::tail : Stretch::gap,
        right_tail ? Stretch::tail : Stretch::gap);
  return {successor_of(strip)};
}

}  // namespace

std::vector<Successor> successors(const ContactEvent& event, const Profile& profile, const Topology& topology,
                                  const std::vector<double>& s) {
  constexpr double vanished = 2.0 * least_length;
  const Strip strip = strip_of(topology, s);
  const auto vanishing_line = [&](int link) {
    return link >= 0 && link < static_cast<int>(strip.parts.size()) &&
           strip.parts[link].kind == Stretch::line && std::abs(s[link + 1] - s[link]) < vanished;
  };
  // With a line that shrinks to nothing its pressure (phi = pi) or its edges' forces may change sign: it leaves a touch.
  const auto gone = [](int link) { return ContactEvent{Kind::length, link, 0.0, 0.0}; };
  switch (event.kind) {
    case Kind::pressure:
      if (vanishing_line(event.place)) return after_length(gone(event.place), strip);
      return after_pressure(event, strip, profile.pieces[event.place]);
    case Kind::length:
      return after_length(event, strip);
    case Kind::force:
      for (const int link : {event.place - 1, event.place})
        if (vanishing_line(link)) return after_length(gone(link), strip);
      return after_force(event, strip);
    case Kind::curvature:
      return after_curvature(event, strip, profile);
    case Kind::graze:
      return after_graze(event, strip);
  }
  return {};
}

}  // namespace windlass::equilibrium
