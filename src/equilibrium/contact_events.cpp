#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

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

/// Least local minimum of the gap to an obstacle inside a free arc. Next to a contact the gap is flat and its samples are
/// rounding; a minimum must stand out by more than that.
ContactEvent graze(const Profile& profile, int obstacle, int link, bool starts_at_mid) {
  constexpr double noise = 1e-11;
  const Piece& piece = profile.pieces[link];
  const obstacle::Surface& surface = profile.obstacles[obstacle];
  const auto at = [&](double value, double s) {
    ContactEvent event{Kind::graze, link, value, s};
    event.obstacle = obstacle;
    return event;
  };
  ContactEvent event = at(far, piece.s(0));
  const Eigen::Index count = piece.s.size();
  Eigen::VectorXd g(count);
  for (Eigen::Index k = 0; k < count; ++k) g(k) = surface.gap(piece.r.col(k));
  if (starts_at_mid && g(0) < g(1)) event = at(g(0), piece.s(0));
  for (Eigen::Index k = 1; k + 1 < count; ++k) {
    if (g(k) > g(k - 1) - noise || g(k) > g(k + 1)) continue;
    const Least least = least_near(piece, g, k);
    if (least.value < event.value) event = at(least.value, least.s);
  }
  return event;
}

double length_of(const Piece& piece) { return piece.s(piece.s.size() - 1) - piece.s(0); }

/// First and second derivative of the pressure at s.
std::pair<double, double> slopes(const Piece& line, double s) {
  Eigen::Index first = 0;
  const Eigen::Index last = line.s.size() - 1;
  while (first + line.stride < last && s > line.s(first + line.stride)) first += line.stride;
  const Eigen::VectorXd nodes = line.s.segment(first, line.stride + 1),
                        p = line.p.segment(first, line.stride + 1);
  const double length = nodes(line.stride) - nodes(0);
  const Eigen::VectorXd scaled = (nodes.array() - nodes(0)) / length;
  Eigen::VectorXd slope(scaled.size());
  for (Eigen::Index k = 0; k < scaled.size(); ++k) slope(k) = bvp::lagrange_slopes(scaled, scaled(k)).dot(p);
  const double x = (s - nodes(0)) / length;
  return {bvp::lagrange_slopes(scaled, x).dot(p) / length,
          bvp::lagrange_slopes(scaled, x).dot(slope) / (length * length)};
}

/// How far p + b x + a x²/2 stays negative from x = 0 on, at most `most`.
double reach(double p, double b, double a, double most) {
  const double root = b * b - 2.0 * a * p;
  if (root < 0.0 || b + std::sqrt(root) <= 0.0) return most;
  return std::min(most, -2.0 * p / (b + std::sqrt(root)));
}

/// Local minima of a line's pressure, the least first; each with where the line pulls about it: no length where it does not.
/// A line that carries no pressure over its length is no less in contact for that; see rod::buckling_margin.
std::vector<ContactEvent> dips(const Piece& line, int link, bool begins_at_mid) {
  if (line.buckling) return {{Kind::pressure, link, far, line.s(0)}};
  const Eigen::Index last = line.s.size() - 1;
  const double begin = line.s(0), end = line.s(last);
  // Pressed evenly it lifts all at once, and a line that shrinks to nothing is not cut.
  Eigen::Index lowest = 0;
  const double least_sample = line.p.minCoeff(&lowest), range = line.p.maxCoeff() - least_sample;
  const bool even = range < 1e-6;
  std::vector<ContactEvent> out;
  for (Eigen::Index k = 0; k <= last; ++k) {
    // The deepest minimum need not be next to the least sample, but next to one that is hardly less deep.
    constexpr double hardly = 0.05;
    const bool dip = (k == 0 || line.p(k - 1) > line.p(k)) && (k == last || line.p(k + 1) > line.p(k)) &&
                     line.p(k) - least_sample < hardly * range;
    if (k != lowest && (even || !dip)) continue;
    const Least least = least_near(line, line.p, k);
    ContactEvent event{Kind::pressure, link, least.value, least.s, least.s, least.s};
    event.passes = !even && end - begin > 10.0 * least_length;
    if (least.value < 0.0) {
      const auto [b, a] = slopes(line, least.s);
      event.from = least.s - reach(least.value, -b, a, least.s - begin);
      event.to = least.s + reach(least.value, b, a, end - least.s);
      if (begins_at_mid && event.from <= begin) event.from = begin - (event.to - begin);
    }
    out.push_back(event);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  return out;
}

/// Positive as long as the line carries the gap that has opened in it.
ContactEvent suction(const Piece& line, const ContactEvent& pressure) {
  ContactEvent event = pressure;
  event.kind = Kind::suction;
  event.passes = false;
  event.redrawn = true;
  const double end = line.s(line.s.size() - 1);
  const bool mirrored = event.from < line.s(0);  // about the mid-point of a half chain
  const bool beside_touch = event.to >= end || (!mirrored && event.from <= line.s(0));
  double carried = beside_touch ? carried_beside_touch : carried_inside;
  if (!beside_touch) {
    // Close to an edge it is carried until it reaches the edge, so that no line, or next to none, is left beyond it.
    const double middle = 0.5 * (event.from + event.to);
    const double edge = mirrored ? end - middle : std::min(end - middle, middle - line.s(0));
    if (edge < gap_reaches_edge * 0.5 * gap_inside * carried)
      carried = std::max(2.0 * edge / gap_inside, carried_beside_touch);
  }
  event.value = !pressure.passes ? 1.0 : 1.0 - (event.to - event.from) / carried;
  return event;
}

/// Two touches at the ends of a short gap: with it their curvature, its height and all that tells them apart vanishes.
bool hardly_apart(const Profile& profile, int link) {
  constexpr double short_gap = 0.02, flat = 1e-6;
  if (profile.pieces[link].stretch != Stretch::gap ||
      length_of(profile.pieces[link]) > short_gap * profile.unit_length)
    return false;
  int touches = 0;
  for (const Contact& c : profile.contacts)
    touches += !c.edge && (c.joint == link || c.joint == link + 1) && c.gap_curvature < flat;
  return touches == 2;
}

/// What meets where a gap closes.
struct Sides {
  int edges = 0, touches = 0;
};

Sides sides(const Profile& profile, int link) {
  Sides out;
  for (const Contact& c : profile.contacts)
    if (c.joint == link || c.joint == link + 1) ++(c.edge ? out.edges : out.touches);
  return out;
}

/// Length below which the line beside a gap carries it; some shorter than it was when it became an arc.
std::optional<double> carried_length(const Sides& at, bool begins_at_mid) {
  constexpr double shorter = 0.75;
  const double inside = shorter * gap_inside * carried_inside;
  if (begins_at_mid && at.edges == 1 && at.touches == 0) return 0.5 * inside;
  if (at.edges == 2) return inside;
  if (at.edges == 1 && at.touches == 1) return shorter * gap_beside_touch * carried_beside_touch;
  return std::nullopt;
}

/// A line without pressure (see rod::buckling_margin) has none to stand for a gap.
bool beside_unpressed(const Profile& profile, int link) {
  const int last = static_cast<int>(profile.pieces.size()) - 1;
  return (link > 0 && profile.pieces[link - 1].buckling) ||
         (link < last && profile.pieces[link + 1].buckling);
}

ContactEvent length_event(const Profile& profile, int i, bool begins_at_mid) {
  const Piece& piece = profile.pieces[i];
  const bool gap = piece.stretch == Stretch::gap;
  const Sides at = gap ? sides(profile, i) : Sides{};
  const auto carried =
      gap && !beside_unpressed(profile, i) ? carried_length(at, begins_at_mid) : std::nullopt;
  const double least = (gap && at.touches == 2 ? least_between_touches : least_length) * profile.unit_length;
  ContactEvent event{Kind::length, i, length_of(piece) - carried.value_or(least), piece.s(0)};
  event.redrawn = carried.has_value();
  event.imminent = hardly_apart(profile, i);
  return event;
}

/// Curvature at which a touch gives way, see `least_curvature`.
double least_curvature_at(const Profile& profile, const Contact& c) {
  if (profile.obstacles[c.obstacle].curvature() != 0.0) return 0.0;
  const Piece& beside =
      profile.pieces[c.joint < static_cast<int>(profile.pieces.size()) ? c.joint : c.joint - 1];
  return least_curvature * std::max(c.force, 0.0) / std::sqrt(beside.n.col(0).norm());
}

}  // namespace

std::string ContactEvent::name() const {
  static const char* const words[] = {"pressure",  "suction", "length",  "force",
                                      "curvature", "graze",   "buckling"};
  const std::string name = std::string(words[static_cast<int>(kind)]) + " " + std::to_string(place);
  return obstacle == 0 ? name : name + ":" + std::to_string(obstacle + 1);
}

std::vector<ContactEvent> contact_events(const Profile& profile, const Topology& topology) {
  std::vector<ContactEvent> events;
  const int count = static_cast<int>(profile.pieces.size());
  for (int i = 0; i < count; ++i) {
    const Piece& piece = profile.pieces[i];
    const bool at_mid = topology.half && i == 0;
    if (piece.stretch == Stretch::line) {
      const std::vector<ContactEvent> pressures = dips(piece, i, at_mid && !topology.mid_touch);
      events.push_back(pressures.front());
      events.push_back(suction(piece, pressures.front()));
      for (std::size_t k = 1; k < pressures.size(); ++k)
        if (const ContactEvent other = suction(piece, pressures[k]); other.value < events.back().value)
          events.back() = other;
    }
    if (piece.stretch != Stretch::tail)
      events.push_back(length_event(profile, i, at_mid && !topology.mid_touch));
    if (piece.stretch == Stretch::line)
      events.push_back({Kind::buckling, i, piece.buckling.value_or(far), piece.s(0)});
    else
      for (int o = 0; o < profile.obstacles.size(); ++o)
        events.push_back(graze(profile, o, i, at_mid && !topology.mid_touch));
  }
  for (const Contact& c : profile.contacts) {
    events.push_back({Kind::force, c.joint, c.force, c.s});
    if (!c.edge)
      events.push_back({Kind::curvature, c.joint, c.gap_curvature - least_curvature_at(profile, c), c.s});
  }
  return events;
}

}  // namespace windlass::equilibrium
