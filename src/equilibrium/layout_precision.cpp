// How far the touches that stand for lines between strands have moved an event.
#include <algorithm>
#include <cmath>

#include "entry.hpp"
#include "line_touches.hpp"
#include "strand_successors.hpp"
#include "windlass/equilibrium/event_precision.hpp"
#include "windlass/equilibrium/opening.hpp"

namespace windlass::equilibrium {

namespace {

using Kind = ContactEvent::Kind;

int links_of_lines(const Topology& topology) {
  const chain::Strands strands(topology);
  int links = 0;
  for (const chain::StrandLine& line : strands.lines()) links += line.links();
  return links;
}

/// The state with more touches in its lines, to be solved for.
struct Denser {
  Successor next;
  Entry entry;
  double part;  ///< that distances between touches are of those before
};

Denser with_denser_touches(Entry& from, double finer) {
  constexpr double enough = 0.7;
  const chain::Profile shape = from.problem->profile(from.x, from.p);
  const Topology& topology = from.problem->topology();
  const Strip strip(topology, from.problem->joint_places(from.x, from.p, shape));
  Successor next = lines_with_denser_touches(shape, topology, strip, finer);
  const auto part = [&] {
    return static_cast<double>(links_of_lines(topology)) / links_of_lines(next.topology);
  };
  if (part() > enough) next = lines_with_denser_touches(shape, topology, strip, finer * finer * part());
  return {next, draft(*from.problem, next, shape, from.p), part()};
}

/// The one of a kind that is nearest to another.
const ContactEvent* nearest(const std::vector<ContactEvent>& events, const ContactEvent& to) {
  const ContactEvent* out = nullptr;
  const auto away = [&](const ContactEvent& event) {
    return std::abs(event.s - to.s) +
           (to.kind == Kind::approach ? std::abs(event.s_other - to.s_other) : 0.0);
  };
  for (const ContactEvent& event : events)
    if (event.kind == to.kind && event.obstacle == to.obstacle && event.mirrored == to.mirrored &&
        (!out || away(event) < away(*out)))
      out = &event;
  return out;
}

/// The event of the state at p, from one nearby.
std::optional<ContactEvent> event_at(Entry& at, const ContactEvent& like) {
  if (at.problem->polish(at.x, at.p) < 0) return std::nullopt;
  const chain::Profile shape = at.problem->profile(at.x, at.p);
  const std::vector<ContactEvent> events = contact_events(shape, at.problem->topology());
  const ContactEvent* found = nearest(events, like);
  if (!found) return std::nullopt;
  ContactEvent out = *found;
  // A touch about to meet the nearer ones is not judged by its curvature, which it has all the same.
  if (out.kind == Kind::curvature)
    for (const chain::Contact& touch : shape.contacts)
      if (touch.joint == out.place && touch.coupling >= 0) out.value = touch.gap_curvature;
  return out;
}

/// Distance in p(0) at which an arc beside a touch of strands has the same length as with fewer touches.
std::optional<double> moved_length(Entry& own, Denser denser, int link) {
  const chain::Profile shape = own.problem->profile(own.x, own.p);
  const std::vector<double> before = own.problem->joint_places(own.x, own.p, shape), &now = denser.next.s;
  const auto same = std::find(now.begin(), now.end(), before[link]);
  if (same == now.end() || *(same + 1) != before[link + 1]) return std::nullopt;
  Entry& at = denser.entry;
  const bool solved = solve_at_length(*at.problem, at.x, at.p, static_cast<int>(same - now.begin()),
                                      before[link + 1] - before[link]);
  return solved ? std::optional(at.p(0) - own.p(0)) : std::nullopt;
}

/// The same of the zero of any other event.
std::optional<double> moved_zero(const ContactEvent& own, Entry denser) {
  constexpr double difference = 1e-6;
  const auto here = event_at(denser, own);
  const double step = difference * std::max(1.0, std::abs(denser.p(0)));
  denser.p(0) += step;
  const auto there = here ? event_at(denser, own) : std::nullopt;
  if (!there || there->value == here->value) return std::nullopt;
  return -(here->value - own.value) * step / (there->value - here->value);
}

}  // namespace

std::optional<double> layout_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                       const std::string& event) {
  constexpr double safety = 2.0, most = 0.1;  // of p: beyond that it is no estimate
  std::optional<double> precision;
  if (links_of_lines(problem.topology()) == 0) return precision;
  tried([&] {
    Entry own{std::static_pointer_cast<RodProblem>(problem.clone()), x, p};
    if (!leave_event(*own.problem, own.x, own.p)) return false;
    const std::vector<ContactEvent> events =
        contact_events(own.problem->profile(own.x, own.p), problem.topology());
    const auto here = std::find_if(events.begin(), events.end(),
                                   [&](const ContactEvent& other) { return other.name() == event; });
    if (here == events.end()) return false;
    const bool length = here->kind == Kind::length && problem.topology().beside_strand(here->place);
    for (const double finer : {2.0, 1.5, 3.0}) {  // of some no state may be found
      const Denser denser = with_denser_touches(own, finer);
      const auto moved = length ? moved_length(own, denser, here->place) : moved_zero(*here, denser.entry);
      const double ratio = denser.part * denser.part;  // what touches h apart move goes with h²
      if (!moved || !(ratio < 1.0)) continue;
      precision = std::min(safety * std::abs(*moved) / (1.0 - ratio), most * std::max(1.0, std::abs(p(0))));
      return true;
    }
    return false;
  });
  return precision;
}

}  // namespace windlass::equilibrium
