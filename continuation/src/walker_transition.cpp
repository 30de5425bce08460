// What happens to a walker when its problem changes: events and adaptation.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "continuation/walker.hpp"
#include "event_by_name.hpp"

namespace continuation {

namespace {

bool same_functions(const std::vector<EventFunction>& a, const std::vector<EventFunction>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const EventFunction& one, const EventFunction& other) { return one.name == other.name; });
}

/// Does `tangent`, at x on the discretisation of now, go the way that `old`, at old_x on that of `before`, went? nullopt: the
/// problem cannot tell.
std::optional<bool> same_way(Problem& now, const Vector& x, const Tangent& tangent, const Problem& before,
                             const Vector& old_x, const Tangent& old, const Vector& p) {
  constexpr double step = 1e-5;  // differences of states: half the digits
  const auto ahead = now.carried_over(before, before.retract(old_x, step * old.x), p);
  const auto here = now.carried_over(before, old_x, p);
  if (!ahead || !here || ahead->size() != x.size() || here->size() != x.size()) return std::nullopt;
  const Vector moved = now.retract(x, step * tangent.x) - x;
  return moved.dot(*ahead - *here) + step * step * tangent.p * old.p > 0.0;
}

}  // namespace

void Walker::adapt() {
  if (!options_.adapt) return;
  // The new tangent is oriented by its parameter component, which says nothing next to a fold.
  const bool turning =
      std::abs(state_.tangent.p) < 2.0 * std::abs(state_.tangent.p - state_.previous_tangent.p);
  const std::shared_ptr<Problem> before = turning ? state_.problem->clone() : nullptr;
  try {
    const std::optional<Vector> adapted = state_.problem->adapt(state_.x, state_.p);
    if (!adapted) return;
    Tangent tangent =
        first_tangent(*state_.problem, *adapted, state_.p, options_, state_.tangent.p < 0.0 ? -1 : 1);
    if (turning) {
      const auto same =
          same_way(*state_.problem, *adapted, tangent, *before, state_.x, state_.tangent, state_.p);
      if (!same) {
        state_.problem = before;
        return;
      }
      if (!*same) tangent = Tangent{-tangent.x, -tangent.p};
    }
    Segment segment(state_.problem, options_, *adapted, state_.p, tangent);
    Sample* sample = segment.at(0.0, true);
    if (!sample) return lose("after adapting the discretisation: " + segment.failure());
    segment.add_events(*sample);
    const double last_ds = state_.last_ds;
    std::vector<EventFunction> previous_events = std::move(state_.previous_events);
    EventSigns signs = state_.signs;
    const bool described_anew = !same_functions(state_.events, sample->events);
    settle(segment, *sample);
    state_.last_ds = last_ds;  // the same point: the rates of events still run from the one before
    if (described_anew) {
      // What only the new description makes negative is still to be passed, but where that has been tried down to the least steps.
      constexpr double many = 100.0;
      if (last_ds > many * options_.step_min)
        for (auto& [name, sign] : state_.signs) {
          const EventFunction* function = find(state_.events, name);
          if (!function || !function->passes) sign = 1;  // one that passes may have either
        }
      state_.previous_events.clear();
    } else {
      state_.signs = std::move(signs);  // what only the new mesh makes negative is still to be passed
      state_.previous_events = std::move(previous_events);
    }
    state_.mesh_changed = true;
    state_.previous_tangent = state_.tangent;
  } catch (const std::domain_error& error) {
    lose(std::string("adapting the discretisation: ") + error.what());
  } catch (const std::runtime_error& error) {
    lose(std::string("adapting the discretisation: ") + error.what());
  }
}

// The mesh suits the point before; at the event itself the error may be another. On one that suits it the function vanishes
// a little beside: there is the event.
void Walker::settle_event(Point& event, const std::string& name) {
  if (!options_.adapt) return;
  const WalkState before = state_;
  state_.problem = state_.problem->clone();
  state_.mesh_changed = false;
  adapt();
  const auto value = [&](const std::vector<EventFunction>& events) -> std::optional<double> {
    const EventFunction* function = find(events, name);
    return function ? std::optional(function->value) : std::nullopt;
  };
  // A state that is described anew has other events.
  if (state_.end || !state_.mesh_changed || !same_functions(before.events, state_.events)) {
    state_ = before;
    return;
  }
  double trial = 1e-6 * step_length_.usual();
  for (int k = 0; k < 5; ++k) {
    const std::optional<double> here = value(state_.events);
    if (!here || std::abs(*here) <= options_.event_zero) break;
    Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
    Sample* beside = segment.at(trial, false);
    if (!beside) break;
    segment.add_events(*beside);
    const std::optional<double> there = value(beside->events);
    if (!there || *there == *here) break;
    const double s = -*here * trial / (*there - *here);
    if (std::abs(s) > 1e-3 * step_length_.usual()) break;  // no zero of a smooth function
    Sample* zero = segment.at(s, true);
    if (!zero) break;
    segment.add_events(*zero);
    const double last_ds = state_.last_ds;
    settle(segment, *zero);
    state_.last_ds = last_ds;
    trial = std::max(std::abs(s), 1e-8 * step_length_.usual());
  }
  event.problem = state_.problem->clone();
  event.x = state_.x;
  event.p = state_.p;
  event.tangent = state_.tangent;
}

// The walker's own state is what lies beyond the event.
void Walker::say_what_follows(Point& event) const {
  event.index_after = state_.index;
  event.next_problem = state_.problem->clone();
  event.next_x = state_.x;
  event.next_p = state_.p;
}

// The zero of a function that may change its sign: a point of the branch, which goes on.
void Walker::note(Point event, const EventFunction& function, const Transition& transition) {
  const int sign = sign_of(state_.signs, function.name);
  state_.signs[function.name] = -sign;
  event.before = sign > 0 ? transition.before : transition.after;
  event.after = sign > 0 ? transition.after : transition.before;
  say_what_follows(event);
  const std::string said = event.before + " -> " + event.after;
  const double here = parameter(state_.p),
               far = std::max(1e-8 * std::max(1.0, std::abs(here)), 2.0 * event.precision);
  const bool image =
      said == state_.noted && std::abs(here - state_.noted_at) <= far;  // of the one just noted
  state_.noted = said;
  state_.noted_at = here;
  if (!image) queue_.push_back(std::move(event));
}

void Walker::pass(Point event, std::size_t which, const std::string& name, int direction, double met) {
  const auto finish = [&](End::Kind kind, const std::string& reason) {
    queue_.push_back(std::move(event));
    pending_end_ = End{kind, reason};
  };
  const auto leap_or = [&](const std::string& reason) {  // the branch is lost for this reason
    if (!leap(event)) return finish(End::Kind::lost, "event " + name + ": " + reason);
    say_what_follows(event);
    const double before = event.p[options_.parameter], precision = event.precision;
    if (event.before != event.after) queue_.push_back(std::move(event));
    stop_before_entry(met, before, precision);
  };
  if (state_.events_in_place > 5) return leap_or("events repeat without progress");
  std::optional<Transition> transition;
  std::string failure;
  try {
    transition = state_.problem->transition(which, state_.x, state_.p);
  } catch (const std::domain_error& error) {
    failure = std::string(": ") + error.what();
  } catch (const std::runtime_error& error) {
    failure = std::string(": ") + error.what();
  }
  if (!transition) return leap_or("no continuation is known" + failure);
  if (const EventFunction* function = find(state_.events, name); function && function->passes)
    return note(std::move(event), *function, *transition);
  event.before = transition->before;
  event.after = transition->after;
  if (!transition->problem) {
    event.precision = std::max(event.precision, transition->precision);
    return finish(End::Kind::event, "event " + name + " ends the branch");
  }
  if (!enter(*transition, direction, name, failure)) return leap_or(failure);
  if (transition->precision >= 0.0) {
    event.problem = transition->problem->clone();
    event.x = transition->state;
    event.p = transition->p;
    event.tangent = state_.tangent;
    event.precision = transition->precision;
    if (!transition->vanishes.empty()) event.event = transition->vanishes;
  }
  if (const auto& located = transition->located) {
    event.problem = located->problem;
    event.x = located->x;
    event.p = located->p;
    event.precision = located->precision;
  }
  say_what_follows(event);
  const double before = event.p[options_.parameter], precision = std::max(event.precision, 0.0);
  if (!transition->silent) queue_.push_back(std::move(event));
  stop_before_entry(met, before, precision);
}

// The branch went on a little beyond the event: a stop value in between, or at the event, is met on the way back to it.
void Walker::stop_before_entry(double met, double event, double precision) {
  const double same = std::max(precision, 1e-10 * std::max(1.0, std::abs(event)));
  for (const double stop : {options_.target, options_.lower, options_.upper}) {
    const double entered = parameter(state_.p);
    const bool at_event = std::abs(stop - event) <= same, is_target = stop == options_.target;
    const bool beyond = (stop - entered) * (entered - event) > 0.0;
    const bool on_the_way = at_event || (met - stop) * (event - stop) <= 0.0;
    const bool passed = (event - stop) * (entered - stop) <= 0.0 || (is_target && on_the_way && !beyond);
    // A walk that begins at the event has it for a bound, found anew.
    if (!passed || (at_event && !is_target)) continue;
    if (stop != entered && !walk_back_to(stop)) {
      pending_end_ =
          at_event ? End{End::Kind::target, "target reached"}  // as near as it can be solved
                   : End{End::Kind::lost, "no state was found between an event and where the branch goes on"};
      return;
    }
    queue_.push_back(here(PointType::end));
    pending_end_ =
        is_target ? End{End::Kind::target, "target reached"} : End{End::Kind::bound, "bound reached"};
    return;
  }
}

bool Walker::walk_back_to(double stop) {
  const double way = stop - parameter(state_.p);
  Tangent back = state_.tangent;
  if (way * back.p < 0.0) back.x = -back.x, back.p = -back.p;
  if (back.p == 0.0) return false;
  try {
    Segment segment(state_.problem, options_, state_.x, state_.p, back);
    // The parameter may change less and less towards the event.
    for (const double longer : {1.0, 1.5, 2.0, 3.0}) {
      const double length = longer * way / back.p;
      Sample *end = segment.at(length, false), *sample = nullptr;
      if (!end) {  // what lies beyond the stop may be too close to the event to be solved: on the chord to half-way
        const Sample* half = segment.at(0.5 * length, false);
        if (half) sample = segment.at_parameter(stop, segment.base(), *half, true);
      } else if (way * (segment.parameter(*end) - stop) >= 0.0) {
        sample = solution_at(segment, stop, segment.base(), *end);
      }
      if (!sample) continue;
      segment.add_events(*sample);
      settle(segment, *sample);
      return true;
    }
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return false;
}

}  // namespace continuation
