#include "opened_entry.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/opening.hpp"

namespace windlass::equilibrium {

namespace {

double length_of(Entry& entry, int link) {
  return entry.problem->chain().length(entry.x, entry.problem->loads(entry.p), link);
}

/// Brings an opened arc to the length that it is entered with, as far as the contacts hold: longer ones lie further from
/// the event, in shorter ones rounding moves the edges, by its size over the edges' force, length³.
void adjust_length(Entry& entry, int link) {
  // Where a line between strands begins, its two touches can hardly be told from one, as those of a gap between two.
  const chain::Topology& topology = entry.problem->topology();
  const chain::Strands strands(topology);
  const bool line = strands.along(link) && strands.line_of(link) == strands.line_of(link + 1),
             strand = !line && topology.beside_strand(link);
  const double factor = strand ? 4.0 : 1.5;
  const chain::Chain& chain = entry.problem->chain();
  const auto is_touch = [&](int joint) { return chain.joint(joint).kind() == contact::JointKind::touch; };
  const double shortest = line || (is_touch(link) && is_touch(link + 1)) ? 2.0 * least_between_touches : 0.06;
  const double entered =
      strand ? entered_beside_strand(*entry.problem) : shortest * entry.problem->rod().unit_length;
  const double now = length_of(entry, link);
  const double change = now > factor * entered ? 1.0 / factor : now < entered ? factor : 1.0;
  if (change == 1.0) return;
  for (double length = change * now; change > 1.0 ? length < factor * entered : length > entered;
       length *= change) {
    Entry next = entry;
    const auto found_again =
        [&] {  // at its load: where two touches of the same strands are too near, it is not
          Vector x = next.x;
          return !strand || entry.problem->polish(x, next.p) >= 0;
        };
    if (!tried([&] {
          return solve_at_length(*entry.problem, next.x, next.p, link, length) && holds(next) &&
                 found_again();
        }))
      return;
    entry = next;
  }
}

/// Brings an opened arc to the length that it has at p(0) = p, by the secant method: its length answers to the load steeply,
/// the load to its length mildly. @returns whether it is there
bool bring_to(Entry& entry, int link, double p) {
  constexpr int most = 20, most_failures = 4;  // in a row: a sixteenth of the step fails, too
  const double close = 1e-10 * std::max(1.0, std::abs(p));
  double last = length_of(entry, link), length = 1.2 * last, last_p = entry.p(0);
  int failures = 0;
  for (int k = 0; k < most && std::abs(last_p - p) > close; ++k) {
    Entry other = entry;
    if (!tried([&] { return solve_at_length(*entry.problem, other.x, other.p, link, length); })) {
      if (++failures > most_failures) return false;
      length = 0.5 * (last + length);
      continue;
    }
    failures = 0;
    const double slope = (other.p(0) - last_p) / (length - last);
    entry = other, last = length, last_p = other.p(0);
    if (slope == 0.0) return false;
    length = std::clamp(last + (p - last_p) / slope, 0.7 * last, 1.4 * last);
  }
  return std::abs(last_p - p) <= close;
}

/// Are two touches that one has split into, no line of theirs, nearer between each other than 2r? Told while they are well apart:
/// what is left of that as they come together is rounding.
bool overlaps_between(Entry& at, int link) {
  const chain::Topology& topology = at.problem->topology();
  const chain::Strands strands(topology);
  const auto& facing = strands.facing(link);
  const bool same_strands = std::any_of(facing.begin(), facing.end(), [&](const auto& stretch) {
    return stretch.begin == link && stretch.end == link + 1;
  });
  if (strands.along(link) || !same_strands) return false;
  const chain::Profile shape = at.problem->profile(at.x, at.p);
  return std::any_of(shape.contacts.begin(), shape.contacts.end(), [&](const chain::Contact& c) {
    return c.coupling >= 0 && (c.joint == link || c.joint == link + 1) && c.gap_curvature < 0.0;
  });
}

/// Is the state on the branch that leaves the event? Where its arc has no length the branch is at the event then. Newton's method may
/// end on a branch that has an arc of this length elsewhere. (Beside strands arcs are entered so short that rounding is in the way.)
bool leaves_event(const Entry& entry, int link, double event) {
  constexpr double together = 1e-6;               // meshes move events by less
  constexpr double part = 0.5, shortest = 0.125;  // what gave way had some length left at the event
  const double away = std::abs(entry.p(0) - event);
  if (entry.problem->topology().beside_strand(link) || away <= together * std::max(1.0, std::abs(event)))
    return true;
  Entry at = entry;
  at.problem = std::static_pointer_cast<RodProblem>(entry.problem->clone());
  std::optional<Vanishing> begins;
  tried([&] {
    begins = where_length_vanishes(*at.problem, at.x, at.p, link, shortest * length_of(at, link));
    return begins.has_value();
  });
  return !begins || std::abs(begins->p - event) <= std::max(part * away, 2.0 * begins->precision);
}

/// What opens right beside another joint is tried shorter than the touch before it would carry: up to that length.
void lengthen(Entry& entry, const std::vector<int>& opened, double length) {
  constexpr int most = 8;
  constexpr double longer = 1.2;
  const auto too_short = [&](const ContactEvent& event) {
    return event.kind == ContactEvent::Kind::length && event.redrawn &&
           std::find(opened.begin(), opened.end(), event.place) != opened.end();
  };
  for (int k = 0; k < most; ++k) {
    std::vector<ContactEvent> events =
        contact_events(entry.problem->profile(entry.x, entry.p), entry.problem->topology());
    const bool enough = admissible(events);
    std::erase_if(events, too_short);
    if (enough || !admissible(events)) return;
    Entry next = entry;
    length *= longer;
    if (!tried([&] { return solve_at_length(*next.problem, next.x, next.p, opened.front(), length); }))
      return;
    entry = next;
  }
}

}  // namespace

std::optional<Entry> open_in_turn(Entry entry, const std::vector<int>& opened, Together& left, bool as_long,
                                  double p) {
  if (left.tries-- <= 0) return std::nullopt;
  if (!settle_shape(*entry.problem, entry.x, entry.p, opened)) return std::nullopt;
  // What only redraws a state leaves all else where it is at the same load; at another, gaps that are open already move far.
  Entry here = entry;
  here.p(0) = p;
  const bool in_place = as_long && tried([&] { return solve_in_place(*here.problem, here.x, here.p); });
  if (in_place) entry = here;
  double length = length_of(entry, opened.front());
  if (entry.problem->topology().beside_strand(opened.front()))
    length = std::max(length, entered_beside_strand(*entry.problem));
  const auto solve = [&] {
    return in_place ? solve_in_place(*entry.problem, entry.x, entry.p)
                    : solve_at_length(*entry.problem, entry.x, entry.p, opened.front(), length);
  };
  if (!in_place && !solve()) return std::nullopt;
  // What is admissible is judged on a mesh that is fine enough: events that only a finer one shows would be passed unseen.
  if (const std::optional<Vector> finer = entry.problem->adapt_mesh(entry.x, entry.p)) {
    entry.x = *finer;
    if (!solve()) return std::nullopt;
  }
  if (!as_long) lengthen(entry, opened, length);
  if (as_long && !in_place && !bring_to(entry, opened.front(), p)) return std::nullopt;
  if (overlaps_between(entry, opened.front())) return std::nullopt;
  const chain::Profile shape = entry.problem->profile(entry.x, entry.p);
  const Topology& topology = entry.problem->topology();
  const std::vector<ContactEvent> events = contact_events(shape, topology);
  if (admissible(events)) {
    if (!in_place && !leaves_event(entry, opened.front(), p)) return std::nullopt;
    if (!as_long) adjust_length(entry, opened.front());
    return entry;
  }
  const auto worst = std::min_element(events.begin(), events.end(),
                                      [](const auto& a, const auto& b) { return a.value < b.value; });
  if (left.depth == 0) return std::nullopt;
  const std::vector<double> s = entry.problem->joint_places(entry.x, entry.p, shape);
  for (const Successor& next : successors(*worst, shape, topology, s)) {
    std::vector<int> all;
    for (const int link : opened) {
      const auto now = std::find(next.source.begin(), next.source.end(), link);
      if (now != next.source.end()) all.push_back(static_cast<int>(now - next.source.begin()));
    }
    all.insert(all.end(), next.opened.begin(), next.opened.end());
    if (all.empty() || next.nothing_left || next.at_rim || next.at_end) continue;
    if (!entry.problem->admits(next.topology)) continue;
    --left.depth;
    auto found = open_in_turn(draft(*entry.problem, next, shape, entry.p), all, left, as_long, p);
    ++left.depth;
    if (found || left.tries <= 0) return found;
  }
  return std::nullopt;
}

}  // namespace windlass::equilibrium
