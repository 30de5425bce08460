#include "windlass/equilibrium/contact_events.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/micro_gap.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Piece;
using chain::Profile;
using chain::Stretch;
using chain::Topology;
using Kind = ContactEvent::Kind;

namespace {

/// Heights inside a line go like the third power of the load: their root is linear in it.
double room_to_grow(const MicroGap& gap) {
  return std::min(1.0 - std::cbrt(gap.height / micro_height), gap.room);
}

}  // namespace

LineContact line_contact_of(const Piece& piece, const Topology& topology, int link, const Scales& scales) {
  const int marker = topology.half ? 0 : static_cast<int>(topology.left.size());
  return line_contact(piece, topology.micro_gaps_of(link), link == marker, link == marker - 1, scales);
}

const MicroGap& shallowest(const LineContact& line) {
  return *std::max_element(line.gaps.begin(), line.gaps.end(),
                           [](const MicroGap& a, const MicroGap& b) { return a.p < b.p; });
}

const MicroGap& tallest(const LineContact& line) {
  return *std::min_element(line.gaps.begin(), line.gaps.end(), [](const MicroGap& a, const MicroGap& b) {
    return room_to_grow(a) < room_to_grow(b);
  });
}

std::optional<double> height_between_lines(const Profile& profile, const Topology& topology, int link,
                                           const Scales& scales) {
  const auto is_line = [&](int i) {
    return i >= 0 && i < static_cast<int>(profile.pieces.size()) &&
           profile.pieces[i].stretch == Stretch::line;
  };
  const Piece& gap = profile.pieces[link];
  const int marker = topology.half ? 0 : static_cast<int>(topology.left.size());
  if (gap.stretch != Stretch::gap) return std::nullopt;
  const bool mid = link == marker, astride = !topology.half && (mid || link == marker - 1);
  if (astride || (mid && topology.mid_touch)) return std::nullopt;
  const bool before = is_line(link - 1), after = is_line(link + 1);
  if (!before && !after) return std::nullopt;
  const int edge = before ? link : link + 1;
  const auto contact = std::find_if(profile.contacts.begin(), profile.contacts.end(),
                                    [&](const Contact& c) { return c.joint == edge; });
  if (contact == profile.contacts.end()) return std::nullopt;
  const double length = gap.s(gap.s.size() - 1) - gap.s(0);
  const bool between = before && after;
  return height_of_gap(contact->force, between ? 0.5 * length : length, !between && !mid, scales);
}

namespace {

/// Value of an event that is nowhere near: no local minimum of the gap, say.
constexpr double far = 1.0;

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

/// Events of a line contact: it opens somewhere, a gap in it closes, a gap in it needs an arc of its own.
void add_line_events(const Piece& piece, const Topology& topology, int i, const Scales& scales,
                     std::vector<ContactEvent>& events) {
  const LineContact line = line_contact_of(piece, topology, i, scales);
  events.push_back({Kind::pressure, i, line.least_pressure / scales.pressure, line.s});
  if (line.gaps.empty()) return;
  const MicroGap& closing = shallowest(line);
  events.push_back({Kind::closure, i, -closing.p / scales.pressure, closing.s});
  const MicroGap& growing = tallest(line);
  events.push_back({Kind::arc, i, room_to_grow(growing), growing.s});
}

double length_of(const Piece& piece) { return piece.s(piece.s.size() - 1) - piece.s(0); }

/// Two touches at the ends of a short gap: with it their curvature, its height and all that tells them apart vanishes.
bool hardly_apart(const Profile& profile, int link) {
  constexpr double short_gap = 0.02, flat = 1e-6;
  if (profile.pieces[link].stretch != Stretch::gap || length_of(profile.pieces[link]) > short_gap)
    return false;
  int touches = 0;
  for (const Contact& c : profile.contacts)
    touches += !c.edge && (c.joint == link || c.joint == link + 1) && c.gap_curvature < flat;
  return touches == 2;
}

ContactEvent length_event(const Profile& profile, const Topology& topology, int i, const Scales& scales) {
  const int mid = static_cast<int>(topology.left.size());
  const double length = length_of(profile.pieces[i]);
  ContactEvent event{Kind::length, i, length - least_length, profile.pieces[i].s(0)};
  event.imminent = hardly_apart(profile, i);
  if (const auto height = height_between_lines(profile, topology, i, scales))
    event.value = std::min(1.0, std::cbrt(*height / arc_height) - 1.0);
  const bool at_mid = !topology.half && !topology.mid_touch && (i == mid || i == mid - 1);
  if (at_mid && one_side_ends(length, length_of(profile.pieces[2 * mid - 1 - i])))
    event.value = length + past_mid;
  return event;
}

}  // namespace

bool one_side_ends(double length, double other_length) {
  constexpr double lasting = 0.05;
  return length < lasting && other_length > lasting;
}

std::string ContactEvent::name() const {
  static const char* const words[] = {"pressure", "length", "force", "curvature", "graze", "closure", "arc"};
  return std::string(words[static_cast<int>(kind)]) + " " + std::to_string(place);
}

std::vector<ContactEvent> contact_events(const Profile& profile, const Topology& topology,
                                         const Scales& scales) {
  std::vector<ContactEvent> events;
  const int count = static_cast<int>(profile.pieces.size());
  for (int i = 0; i < count; ++i) {
    const Piece& piece = profile.pieces[i];
    const bool at_mid = i == static_cast<int>(topology.left.size());
    if (piece.stretch == Stretch::line) add_line_events(piece, topology, i, scales, events);
    if (piece.stretch != Stretch::tail) events.push_back(length_event(profile, topology, i, scales));
    if (piece.stretch != Stretch::line) events.push_back(graze(piece, i, at_mid && !topology.mid_touch));
  }
  for (const Contact& c : profile.contacts) {
    events.push_back({Kind::force, c.joint, c.force / scales.force, c.s});
    if (!c.edge) events.push_back({Kind::curvature, c.joint, c.gap_curvature, c.s});
  }
  return events;
}

}  // namespace windlass::equilibrium
