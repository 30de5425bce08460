#include "strand_successors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace windlass::equilibrium {

using chain::Stretch;

namespace {

/// A touch between strands passes the edge of a line contact: the gap between the two is a stretch of the line now, or the
/// other way round.
std::optional<Successor> strand_passes_edge(int link, Strip strip) {
  const auto strand = [&](int joint) { return strip.on[joint].strand != 0; };
  const bool before = link > 0 && strand(link), after = strand(link + 1);
  const bool line = strip.is_line(link);
  // The other joint is an edge: of the line itself, or of the one beyond the gap.
  const bool from_left = after && !before && link > 0 && strip.is_line(link - 1) != line;
  const bool from_right = before && !after && strip.is_line(link + 1) != line;
  if (!from_left && !from_right) return std::nullopt;
  strip.parts[link].kind = line ? Stretch::gap : Stretch::line;
  strip.parts[link].fresh = true;
  const int edge = from_left ? link : link + 1, other = from_left ? link + 1 : link;
  const int obstacle = strip.on[edge].obstacle;
  std::swap(strip.on[edge], strip.on[other]);
  strip.on[edge].obstacle = strip.on[other].obstacle = obstacle;
  if (chain::Seat& free = strip.on[edge]; line && free.flat >= 0) free.obstacle = free.flat;  // in the plate
  measure_parts(strip);
  return strip.successor();
}

/// A touch with a strand that presses on a line passes the place where the line leaves a plate.
std::optional<Successor> strand_passes_lift_off(int link, Strip strip) {
  const auto flat = [&](int part) { return strip.is_line(part) ? strip.on[part].flat : -1; };
  const bool before = strip.on[link].strand != 0, after = strip.on[link + 1].strand != 0;
  const int beside = before ? link + 1 : link - 1;  // beyond the place
  if (before == after || !strip.is_line(link) || !strip.is_line(link - 1) || !strip.is_line(link + 1) ||
      flat(link) == flat(beside))
    return std::nullopt;
  const int inside = flat(beside), behind = flat(link + 1);
  std::swap(strip.on[link], strip.on[link + 1]);
  strip.on[link].flat = inside, strip.on[link + 1].flat = behind;
  strip.parts[link].fresh = true;
  measure_parts(strip);
  return strip.successor();
}

/// Two touches with different strands pass each other along the rod; on a half chain one may pass its own image at s = 0,
/// and is then pressed on by the image of what pressed on it.
std::optional<Successor> touches_pass(int link, Strip strip) {
  const auto strand = [&](int joint) { return std::abs(strip.on[joint].strand); };
  if (strip.starts_at_mid(link)) {
    if (strip.mid_touch || strand(1) == 0 || partner(strip, 1) == 1) return std::nullopt;
    strip.on[1].strand = -strip.on[1].strand;
  } else {
    if (strand(link) == 0 || strand(link + 1) == 0 || strand(link) == strand(link + 1)) return std::nullopt;
    std::swap(strip.on[link], strip.on[link + 1]);
    std::swap(strip.on[link].obstacle, strip.on[link + 1].obstacle);
  }
  strip.parts[link].fresh = true;
  measure_parts(strip);
  return strip.successor();
}

/// What is marked on the touch that two become, the one at `joint` and the next: of a line of these two alone nothing; else they
/// are of the same line now, inside it if either was one.
void unite_marks(int joint, Strip& strip) {
  chain::Seat &first = strip.on[joint], &second = strip.on[joint + 1];
  const int low = first.line, high = second.line;
  if (low == high) {
    first.line = 0;
    return;
  }
  if (low != 0 && high != 0)
    for (chain::Seat& seat : strip.on)
      if (std::abs(seat.line) == std::abs(high)) seat.line = seat.line == high ? low : -low;
  first.line = low != 0 ? low : high;
  first.part = low != 0 && high != 0 ? 0.5 : 0.0;
}

/// Two touches of the same two strands meet, at both places, and are one.
std::optional<Successor> touches_meet(int link, Strip strip) {
  if (strip.starts_at_mid(link) || strip.on[link].strand == 0 || strip.on[link + 1].strand == 0)
    return std::nullopt;
  const int first = partner(strip, link), second = partner(strip, link + 1);
  if (first == link + 1) {  // a line between a strand and its own image
    unite_marks(link, strip);
    strip.collapse(link);
    return strip.successor();
  }
  if (std::abs(first - second) != 1) return std::nullopt;
  const int other = std::min(first, second), strand = strip.on[link].strand;
  const bool image = strip.on[first].strand != strand;
  for (const int joint : {other, link}) unite_marks(joint, strip);
  strip.on[other].strand = image ? -strand : strand;
  for (const int gap : {std::max(link, other), std::min(link, other)}) strip.collapse(gap);
  measure_parts(strip);
  return strip.successor();
}

}  // namespace

int partner(const Strip& strip, int j) {
  const int strand = std::abs(strip.on[j].strand);
  for (int k = 0; k < static_cast<int>(strip.on.size()); ++k)
    if (k != j && std::abs(strip.on[k].strand) == strand) return k;
  return j;
}

int new_strand(const Strip& strip) {
  int most = 0;
  for (const chain::Seat& seat : strip.on)
    most = std::max({most, std::abs(seat.strand), std::abs(seat.line)});
  return most + 1;
}

std::optional<Successor> after_length_beside_strand(int link, const Strip& strip) {
  if (const auto met = touches_meet(link, strip)) return met;
  if (const auto passed = touches_pass(link, strip)) return passed;
  if (const auto passed = strand_passes_lift_off(link, strip)) return passed;
  return strand_passes_edge(link, strip);
}

void add_touch(Strip& strip, double at, const chain::Seat& seat) { strip.cut(strip.part_at(at), at, seat); }

void add_pair(Strip& strip, double s, double other, bool mirrored, bool own_strand, chain::Seat seat) {
  constexpr double same = 1e-6;
  add_touch(strip, s, seat);
  if (mirrored && own_strand && std::abs(s - other) < same) return;  // its own image
  if (mirrored) seat.strand = -seat.strand;
  if (!own_strand) seat.line = -seat.line;
  add_touch(strip, other, seat);
}

void take_out(int j, Strip& strip) {
  const int other = partner(strip, j);
  for (const int joint : {std::max(j, other), std::min(j, other)}) {
    strip.merge(joint - 1, joint, joined(strip.parts[joint - 1].kind, strip.parts[joint].kind));
    if (j == other) break;
  }
}

std::vector<Successor> strands_part(int j, Strip strip) {
  take_out(j, strip);
  measure_parts(strip);
  return {strip.successor()};
}

std::vector<Successor> strand_lifts(int j, Strip strip) {
  const double s = strip.s[j],
               length = std::min({0.05, 0.2 * (s - strip.s[j - 1]), 0.2 * (strip.s[j + 1] - s)});
  const chain::Seat seat = strip.on[j];
  strip.split(j, s + length, Stretch::gap, Stretch::line);
  strip.split(j - 1, s - length, Stretch::line, Stretch::gap);
  strip.on[j] = strip.on[j + 2] = {seat.obstacle, 0};
  strip.on[j + 1] = seat;
  strip.parts[j].fresh = strip.parts[j + 1].fresh = true;
  return {strip.successor()};
}

std::vector<Successor> strands_meet(const ContactEvent& event, Strip strip) {
  const int strand = new_strand(strip);
  add_pair(strip, event.s, event.s_other, event.mirrored, event.place == event.other, {0, strand});
  return {strip.successor()};
}

double foot(const chain::Profile& profile, double s, double guess, bool mirrored) {
  constexpr int iterations = 8;
  constexpr double step = 1e-3;
  const Eigen::Vector3d at = profile.at(s).r, turn(mirrored ? -1.0 : 1.0, 1.0, mirrored ? -1.0 : 1.0);
  const auto distance = [&](double other) {
    return (at - turn.cwiseProduct(profile.at(other).r)).squaredNorm();
  };
  double other = guess;
  for (int k = 0; k < iterations; ++k) {
    const double low = distance(other - step), here = distance(other), high = distance(other + step);
    const double bend = high - 2.0 * here + low;
    if (bend <= 0.0) break;
    other -= std::clamp(0.5 * step * (high - low) / bend, -10.0 * step, 10.0 * step);
  }
  return other;
}

namespace {

/// A touch stays, and beside it the strands meet, too: where its curvature is lost and the next derivative of the distance is not. The
/// strands are apart between the two, or these are the ends of a line.
std::vector<Successor> strands_meet_beside(int j, const Strip& strip, const chain::Profile& profile) {
  const int other = partner(strip, j), fresh = new_strand(strip);
  const bool mirrored = strip.on[j].strand != strip.on[other].strand;
  const double unit = profile.unit_length;
  std::vector<Successor> out;
  for (const int line : {0, fresh})
    for (const double length : {0.02, 0.01, 0.04, 0.005})
      for (const double side : {1.0, -1.0}) {
        const double s = strip.s[j] + side * length * unit;
        const double met = foot(profile, s, strip.s[other], mirrored);
        Strip next = strip;
        if (line != 0) next.on[j].line = line, next.on[other].line = -line;
        add_pair(next, s, met, mirrored, false, {.strand = fresh, .line = line});
        for (const auto& [one, two] : {std::pair(s, strip.s[j]), std::pair(met, strip.s[other])}) {
          auto& part = next.parts[next.part_at(0.5 * (one + two))];
          part.fresh = true;
        }
        out.push_back(next.successor());
      }
  return out;
}

/// How far from joints the next ones are.
double room_beside(const Strip& strip, std::initializer_list<int> joints) {
  double out = HUGE_VAL;
  for (const int j : joints) out = std::min({out, strip.s[j] - strip.s[j - 1], strip.s[j + 1] - strip.s[j]});
  return out;
}

}  // namespace

std::vector<Successor> strands_split(const ContactEvent& event, const Strip& strip,
                                     const chain::Profile& profile) {
  const int j = event.place, other = partner(strip, j);
  const int old = strip.on[j].strand, fresh = new_strand(strip);
  std::vector<Successor> out;
  // Two touches, the strands apart between them, or the ends of a line. On obstacles two touches next to each other are that.
  std::vector<double> lengths{0.05, 0.02, 0.1};
  for (double& length : lengths) length *= profile.unit_length;
  if (const double opens = event.to - event.from; event.kind == ContactEvent::Kind::dip)
    lengths.insert(lengths.begin(), std::min(opens, lengths.back()));
  // Right beside another joint what opens does not reach it at first.
  if (const double room = 1.8 * room_beside(strip, {j, other}); room < lengths.front())
    lengths.insert(lengths.begin(), room);
  const bool dips = event.kind == ContactEvent::Kind::dip && event.to > event.from;
  const double part = dips ? (event.s - event.from) / (event.to - event.from) : 0.5;
  for (const int line : {event.presses ? fresh : 0, event.presses ? 0 : fresh})
    for (const double length : lengths) {
      Strip split = strip;
      const auto widen = [&](int joint, int before, int after, int mark, double opened, double share) {
        const bool on_line = split.is_line(joint - 1) && split.is_line(joint);
        split.split(joint, strip.s[joint] + (1.0 - share) * opened, on_line ? Stretch::line : Stretch::gap,
                    split.parts[joint].kind);
        split.on[joint].line = mark;
        split.on[joint + 1] = split.on[joint];
        split.s[joint] -= share * opened;
        split.on[joint].strand = before;
        split.on[joint + 1].strand = after;
        split.parts[joint].fresh = true;
      };
      if (j == other) {
        widen(j, old, -old, line, length, 0.5);
        out.push_back(split.successor());
        continue;
      }
      for (const bool opposite : {true, false}) {
        split = strip;
        const int low = std::min(j, other), high = std::max(j, other);
        const int sign = strip.on[low].strand == strip.on[high].strand ? 1 : -1;
        const int first = std::abs(strip.on[low].strand);
        // Images run the other way.
        const bool crossed = opposite == (sign > 0);
        const double ratio = dips ? std::abs(profile.contact_at(j)->place_ratio) : 1.0;
        const double at_other = opposite ? 1.0 - part : part;
        widen(high, sign * (crossed ? fresh : first), sign * (crossed ? first : fresh), -line,
              j == high ? length : ratio * length, j == high ? part : at_other);
        widen(low, first, fresh, line, j == low ? length : ratio * length, j == low ? part : at_other);
        out.push_back(split.successor());
      }
    }
  if (j != other) {
    const std::vector<Successor> beside = strands_meet_beside(j, strip, profile);
    out.insert(out.end(), beside.begin(), beside.end());
  }
  return out;
}

int image_line(const Successor& next, int joint) {
  const int line = next.topology.seat(joint).line, count = static_cast<int>(next.s.size());
  if (line == 0) return 0;
  for (int j = 0; j < count; ++j)
    if (next.topology.seat(j).line == -line && next.s[j] * next.s[joint] < 0.0) return -line;
  return line > 0 ? line + count : line - count;  // both strands on this side: a line of its own
}

int image_strand(const Successor& next, int joint) {
  const auto strand = [&](int j) { return next.topology.seat(j).strand; };
  const int count = static_cast<int>(next.s.size());
  int other = -1, image = -1;
  for (int j = 0; j < count; ++j)
    if (j != joint && strand(j) == strand(joint)) other = j;
  if (other < 0 || strand(joint) == 0) return strand(joint);
  if (next.s[other] * next.s[joint] > 0.0)
    return strand(joint) + count;  // both on this side: a touch of its own
  for (int j = 0; j < count; ++j)
    if (strand(j) != 0 && next.s[j] * next.s[joint] > 0.0 &&
        (image < 0 || std::abs(next.s[j] + next.s[other]) < std::abs(next.s[image] + next.s[other])))
      image = j;
  return strand(image);
}

}  // namespace windlass::equilibrium
