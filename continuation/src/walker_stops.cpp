// Where a step is cut short: stop values of the parameter, the start of a closed curve, events.

#include <algorithm>
#include <cmath>
#include <utility>

#include "continuation/walker.hpp"
#include "event_by_name.hpp"

namespace continuation {
namespace {

double rms(const Vector& a) {
  return a.size() == 0 ? 0.0 : a.norm() / std::sqrt(static_cast<double>(a.size()));
}

// p between the two samples equals value; the first one itself does not count.
bool crosses(const Segment& segment, const Sample& lo, const Sample& hi, double value) {
  const double a = segment.parameter(lo) - value, b = segment.parameter(hi) - value;
  return std::isfinite(value) && a != 0.0 && (b == 0.0 || (a < 0.0) != (b < 0.0));
}

// Where in a step an event function that is positive at both ends may have been negative: the parabola
// through its values at the last three points has its least value there, small beside the ends'. In the
// branch's order.
std::vector<double> dips(const WalkState& before, const Sample& end) {
  constexpr double small =
      0.25;  // of the ends' values: the parabola is that wrong where the bend changes by it
  std::vector<double> places;
  if (!(before.last_ds > 0.0)) return places;
  for (const EventFunction& event : before.events) {
    const EventFunction *last = find(before.previous_events, event.name),
                        *next = find(end.events, event.name);
    if (!last || !next) continue;
    const int sign = sign_of(before.signs, event.name);
    const double a = sign * last->value, b = sign * event.value, c = sign * next->value;
    if (!(b > 0.0) || !(c > 0.0)) continue;
    const double fall = (b - a) / before.last_ds,
                 bend = ((c - b) / end.s - fall) / (before.last_ds + end.s),  // half the second derivative
        slope = fall + bend * before.last_ds;
    if (!(slope < 0.0) || !(bend > 0.0)) continue;
    const double s = -0.5 * slope / bend;
    if (s < end.s && b + 0.5 * slope * s < small * std::min(b, c)) places.push_back(s);
  }
  std::sort(places.begin(), places.end());
  return places;
}

// The first event up to `end`, those included that are over by then. Behind a turn of the parameter may lie the mirror image of
// what is before it, at a branch point: functions are alike there, and what they are in between they are at the turn.
std::optional<Located> first_event(Segment& segment, const Sample& end, const WalkState& before,
                                   const Located* turn) {
  std::optional<Located> event = locate_first_event(segment, end, before.signs);
  std::vector<double> places = dips(before, end);
  if (turn && turn->s < end.s)
    places.insert(std::upper_bound(places.begin(), places.end(), turn->s), turn->s);
  for (const double s : places) {
    if (event && s >= event->s) break;
    Sample* lowest = segment.at(s, false);
    if (!lowest) continue;
    if (lowest->events.empty()) segment.add_events(*lowest);
    if (auto earlier = locate_first_event(segment, *lowest, before.signs)) return earlier;
  }
  return event;
}

}  // namespace

// F may not exist beyond an event (a length below zero): then steps fail all the way to it. An event
// function that vanishes within a few smallest steps, going on as between the last two points, is taken to
// have its zero here.
bool Walker::event_at_edge() {
  if (!options_.detect_events || !(state_.last_ds > 0.0)) return false;
  const double reach = 100.0 * options_.step_min;
  for (std::size_t i = 0; i < state_.events.size(); ++i) {
    const EventFunction& event = state_.events[i];
    const EventFunction* before = find(state_.previous_events, event.name);
    if (!before || event.passes || event.value < 0.0) continue;
    const double rate = (event.value - before->value) / state_.last_ds;
    if (event.imminent ? rate >= 0.0 : event.value + rate * reach >= 0.0) continue;
    Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
    Located located;
    located.type = PointType::event;
    located.event = event.name;
    located.which = i;
    located.sample = segment.base();
    located.index = state_.index;
    located.hi = -event.value / rate;
    located.precision = located.hi;
    located.note = "at the edge of the domain of F, extrapolated";
    Point point = special(segment, located);
    ++state_.events_in_place;
    ++state_.points;
    const double met = point.p[options_.parameter];
    pass(std::move(point), i, event.name, state_.tangent.p < 0.0 ? -1 : 1, met);
    return true;
  }
  return false;
}

// Shortens the step to where a stop value, the start of a closed curve or an event is met.
bool Walker::shorten(Segment& segment, Sample*& end, Located* turn, End& reason,
                     std::optional<Located>& event, std::string& failure) {
  if (!limit(segment, end, turn, reason)) return failure = segment.failure(), false;
  if (!reason && options_.detect_closed) {
    if (Sample* closing = close(segment, *end, turn)) {
      end = closing;
      reason = End{End::Kind::closed, "closed: the branch is back at its start"};
    }
  }
  segment.add_events(*end);
  if (options_.detect_events) event = first_event(segment, *end, state_, turn);
  if (!event) return true;
  if (!event->note.empty()) return failure = "event " + event->event + ": " + event->note, false;
  if (event->s > 0.0) {
    end = segment.at(event->s, true);
    if (!end) return failure = segment.failure(), false;
  } else {
    end = &segment.base();
  }
  if (end->events.empty()) segment.add_events(*end);
  event->sample = *end;
  reason = {};
  return true;
}

// The user functions' zeros up to `end`, which moves to the first one that stops the branch.
bool Walker::find_functions(Segment& segment, Sample*& end, End& reason, std::optional<Located>& event,
                            std::vector<Located>& found, std::string& failure) {
  for (const UserFunction& function : options_.functions) {
    std::optional<Located> zero = locate_function(segment, function, segment.base(), *end);
    if (!zero) continue;
    if (function.stop) {
      end = segment.at(zero->s, true);
      if (!end) return failure = segment.failure(), false;
      if (end->events.empty()) segment.add_events(*end);
      reason = End{End::Kind::function, function.name + " is zero"};
      event.reset();
    }
    found.push_back(std::move(*zero));
  }
  std::erase_if(found, [&](const Located& l) { return l.s > end->s; });
  return true;
}

// The solution at a value of p that two samples lie to either side of; null where it cannot be found.
Sample* Walker::solution_at(Segment& segment, double value, const Sample& lo, const Sample& hi) {
  Sample* sample = segment.at_parameter(value, lo, hi, true);
  if (sample && sample->s >= lo.s && sample->s <= hi.s) return sample;
  const Bracket bracket = find_zero(lo.s, segment.parameter(lo) - value, hi.s, segment.parameter(hi) - value,
                                    1e-12, [&](double s) -> std::optional<double> {
                                      const Sample* middle = segment.at(s, false);
                                      if (!middle) return std::nullopt;
                                      return segment.parameter(*middle) - value;
                                    });
  sample = segment.at(bracket.best, true);
  return bracket.converged ? sample : nullptr;
}

// Shortens the step to where p meets a stop value, if it does; false where that solution cannot be found.
bool Walker::limit(Segment& segment, Sample*& end, Located* fold, End& reason) {
  const std::pair<double, const char*> stops[] = {
      {options_.target, "target"}, {options_.lower, "lower bound"}, {options_.upper, "upper bound"}};
  Sample* last = end;
  const auto check = [&](const Sample& lo, Sample& hi) {
    for (const auto& [value, what] : stops) {
      if (!crosses(segment, lo, hi, value)) continue;
      Sample* sample = solution_at(segment, value, lo, hi);
      if (!sample) return false;
      if (!reason || sample->s < end->s) {
        end = sample;
        reason = End{value == options_.target ? End::Kind::target : End::Kind::bound,
                     std::string(what) + " reached"};
      }
    }
    return true;
  };
  if (!fold) return check(segment.base(), *last);
  if (!check(segment.base(), fold->sample)) return false;
  return reason || check(fold->sample, *last);
}

// The sample at the start's parameter if it is the start, that is if the branch is a closed curve.
Sample* Walker::close(Segment& segment, Sample& end, Located* fold) {
  if (state_.points < 4) return nullptr;
  Sample& middle = fold ? fold->sample : end;
  const bool first_half = state_.tangent.p * state_.start_slope > 0.0;
  if (!first_half && (!fold || end.tangent.p * state_.start_slope <= 0.0)) return nullptr;
  Sample& lo = first_half ? segment.base() : middle;
  Sample& hi = first_half ? middle : end;
  if (!crosses(segment, lo, hi, state_.start_parameter)) return nullptr;
  const bool comparable = !state_.mesh_changed;
  if (comparable &&
      rms(state_.x - state_.start_x) > 3.0 * rms(end.it.x - state_.x) + 1e-3 * options_.state_scale)
    return nullptr;
  Sample* sample = segment.at_parameter(state_.start_parameter, lo, hi, true);
  if (!sample || sample->s < 0.0 || sample->s > end.s) return nullptr;
  if (comparable &&
      rms(sample->it.x - state_.start_x) <= 1e-6 * std::max(options_.state_scale, rms(state_.start_x)))
    return sample;
  if (comparable) return nullptr;
  const Vector now = state_.problem->fingerprint(sample->it.x, sample->it.p);
  // Another mesh: equal only within its error.
  const bool same = now.size() == state_.start_fingerprint.size() &&
                    rms(now - state_.start_fingerprint) <=
                        1e-5 * std::max(options_.state_scale, rms(state_.start_fingerprint));
  return same ? sample : nullptr;
}

}  // namespace continuation
