#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/rod/free_flow.hpp"

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

/// Least value of a sampled quantity between lo and hi, on the polynomials of the elements to the two sides of s, where it is
/// `value`: an event located by samples would move with the mesh.
Least least_near(const Piece& piece, const Eigen::VectorXd& values, double s, double value, double lo,
                 double hi) {
  constexpr int bits = 26;  // half of a double: a minimum is flat
  Least least{value, s};
  const Eigen::Index last = piece.s.size() - 1;
  for (const int way : {-1, 1}) {
    Eigen::Index first = 0;  // of the element on that side
    while (first + piece.stride < last &&
           (way > 0 ? s >= piece.s(first + piece.stride) : s > piece.s(first + piece.stride)))
      first += piece.stride;
    const Eigen::VectorXd nodes = piece.s.segment(first, piece.stride + 1);
    const double begin = nodes(0), length = nodes(piece.stride) - begin, x = (s - begin) / length;
    const double from = way < 0 ? std::max(0.0, (lo - begin) / length) : x;
    const double to = way < 0 ? x : std::min(1.0, (hi - begin) / length);
    if (!(to > from)) continue;
    const Eigen::VectorXd scaled = (nodes.array() - begin) / length;
    const auto polynomial = [&](double at) {
      return bvp::lagrange_basis(scaled, at).dot(values.segment(first, piece.stride + 1));
    };
    const auto [at, found] = boost::math::tools::brent_find_minima(polynomial, from, to, bits);
    if (found < least.value) least = {found, begin + length * at};
  }
  return least;
}

/// Samples of an element.
constexpr int element_parts = 24;

/// A quantity along an arc, dense enough that no dip and no rise of its polynomials is missed.
struct Dense {
  Eigen::VectorXd s, value;
};

Dense dense_samples(const Piece& piece, const Eigen::VectorXd& values) {
  constexpr int parts = element_parts;
  const Eigen::Index stride = piece.stride, elements = (piece.s.size() - 1) / stride;
  Dense out{Eigen::VectorXd(elements * parts + 1), Eigen::VectorXd(elements * parts + 1)};
  const double first_length = piece.s(stride) - piece.s(0);
  const Eigen::VectorXd scaled = (piece.s.head(stride + 1).array() - piece.s(0)) / first_length;  // of each
  Eigen::MatrixXd basis(parts, stride + 1);
  for (int k = 0; k < parts; ++k)
    basis.row(k) = bvp::lagrange_basis(scaled, static_cast<double>(k) / parts).transpose();
  for (Eigen::Index e = 0; e < elements; ++e) {
    const double begin = piece.s(e * stride), length = piece.s((e + 1) * stride) - begin;
    for (int k = 0; k < parts; ++k) out.s(e * parts + k) = begin + length * k / parts;
    out.value.segment(e * parts, parts).noalias() = basis * values.segment(e * stride, stride + 1);
  }
  out.s(elements * parts) = piece.s(elements * stride);
  out.value(elements * parts) = values(elements * stride);
  return out;
}

/// A least gap found on an element's polynomial, brought to where it is on the rod's own way through the element: between the
/// element's ends, where the state is known to more digits, the polynomial may be off by more than events allow, and
/// next to a contact may dip where the rod does not. Nothing where the rod has no least gap there but its contact.
std::optional<Least> on_its_way(const Profile& profile, const Piece& piece, const obstacle::Surface& surface,
                                double s) {
  Eigen::Index node = 0;
  const Eigen::Index last = piece.s.size() - 1;
  while (node + piece.stride < last && s > piece.s(node + piece.stride)) node += piece.stride;
  const rod::Section start{piece.r.col(node), piece.m.col(node), piece.q.col(node)};
  const Eigen::Vector3d n = piece.n.col(node);
  const double reach = piece.s(node + piece.stride) - piece.s(node);
  const auto section_at = [&](double at) {
    return rod::free_flow(start, n, profile.material, at - piece.s(node));
  };
  const auto slope_at = [&](const rod::Section& at) {
    return surface.normal(at.r).dot(rod::directors(at.q).col(2));
  };
  constexpr double beside = 1e-4;
  rod::Section at = section_at(s);
  double step = reach;
  for (int k = 0; k < 6 && std::abs(step) > beside * beside; ++k) {
    const double slope = slope_at(at), curvature = (slope_at(section_at(s + beside)) - slope) / beside;
    step = -slope / curvature;
    if (!(curvature > 0.0) || std::abs(step) > reach) return std::nullopt;
    at = section_at(s += step);
  }
  const double from_ends = std::min(s - piece.s(0), piece.s(last) - s);
  if (from_ends < beside * reach) return std::nullopt;
  return Least{surface.gap(at.r), s};
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
  const Dense dense = dense_samples(piece, g);
  for (Eigen::Index k = 1; k + 1 < dense.s.size(); ++k) {
    if (dense.value(k) > dense.value(k - 1) - noise || dense.value(k) > dense.value(k + 1)) continue;
    std::optional<Least> least =
        least_near(piece, g, dense.s(k), dense.value(k), dense.s(k - 1), dense.s(k + 1));
    constexpr double near = 1e-3;
    if (piece.stride > 1 && least->value < near * profile.unit_length)
      least = on_its_way(profile, piece, surface, least->s);
    if (least && least->value < event.value) event = at(least->value, least->s);
  }
  return event;
}

double length_of(const Piece& piece) { return piece.s(piece.s.size() - 1) - piece.s(0); }

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
std::vector<ContactEvent> dips(const Piece& line, const Dense& dense, int link, bool begins_at_mid) {
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
    event.passes = !even && end - begin > 10.0 * least_length;
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
ContactEvent suction(const Dense& line, const ContactEvent& pressure, const std::vector<ContactEvent>& dips) {
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
    event.value = 1.0 - std::cbrt(pull * width * width / carried_beside_touch);
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
  // Close to an edge it is carried until it reaches the edge, so that no line, or next to none, is left beyond it.
  const double middle = 0.5 * (event.from + event.to), carried = width / part;
  const double edge = mirrored ? end - middle : std::min(end - middle, middle - begin);
  const bool close = edge < gap_reaches_edge * 0.5 * gap_inside * carried;
  event.value = 1.0 - (close ? width / std::max(2.0 * edge / gap_inside, 0.5 * carried) : part);
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

/// Length of a gap over that which its line carries, by the forces at its ends, less than the one when it became an arc; nothing
/// where no line carries it.
std::optional<double> beyond_carried(const Profile& profile, int link, bool begins_at_mid) {
  constexpr double shorter = 0.75;
  int edges = 0, touches = 0;
  double force = 0.0;
  for (const Contact& c : profile.contacts) {
    if (c.joint != link && c.joint != link + 1) continue;
    ++(c.edge ? edges : touches);
    if (c.edge) force += c.force;
  }
  const bool about_mid = begins_at_mid && edges == 1 && touches == 0,
             beside_touch = edges == 1 && touches == 1;
  if (!about_mid && !beside_touch && edges != 2) return std::nullopt;
  const double length = length_of(profile.pieces[link]), mean = std::max(force / edges, 0.0);
  const double height = 0.96 * mean * std::pow(about_mid ? length : 0.5 * length, 3);
  double part = std::pow(height / carried_inside, 1.0 / 6.0);
  // Beside a touch the gap may have opened inside the line and reached its edge.
  if (beside_touch) part = std::max(part, std::cbrt(4.32 * mean * length / carried_beside_touch));
  return part - shorter;
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
  const auto carried =
      gap && !beside_unpressed(profile, i) ? beyond_carried(profile, i, begins_at_mid) : std::nullopt;
  const auto is_touch = [&](const Contact& c) { return !c.edge && (c.joint == i || c.joint == i + 1); };
  const bool between_touches =
      gap && std::count_if(profile.contacts.begin(), profile.contacts.end(), is_touch) == 2;
  const double shortest = piece.stretch == Stretch::tail ? shortest_tail
                          : between_touches              ? least_between_touches
                                                         : least_length;
  const double least = shortest * profile.unit_length;
  ContactEvent event{Kind::length, i, carried.value_or(length_of(piece) - least), piece.s(0)};
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
      const bool from_mid = at_mid && !topology.mid_touch;
      const Dense dense = dense_samples(piece, piece.p);
      const std::vector<ContactEvent> pressures = dips(piece, dense, i, from_mid);
      const std::vector<ContactEvent> all = from_mid ? on_both_halves(pressures, piece.s(0)) : pressures;
      events.push_back(pressures.front());
      events.push_back(suction(dense, pressures.front(), all));
      for (std::size_t k = 1; k < pressures.size(); ++k)
        if (const ContactEvent other = suction(dense, pressures[k], all); other.value < events.back().value)
          events.back() = other;
    }
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
