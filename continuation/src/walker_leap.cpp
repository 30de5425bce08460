// How a walker goes on where it cannot pass an event: over it, to a state of whatever description holds a little further on.

#include <array>
#include <cmath>
#include <stdexcept>

#include "continuation/walker.hpp"

namespace continuation {

namespace {

// Of the usual step. What happens within is told as one event, whose precision the leap is.
constexpr std::array leaps{0.01, 0.03, 0.1, 0.3, 1.0};

}  // namespace

// The state that holds so far along the branch, if one is found. @param direction  of the parameter, there
std::optional<Transition> Walker::leap_to(double length, int& direction) {
  Segment ahead(state_.problem->clone(), options_, state_.x, state_.p, state_.tangent);
  Vector x = state_.problem->retract(state_.x, length * state_.tangent.x), p = state_.p;
  parameter(p) += length * state_.tangent.p;
  // Beyond the event this description may still have solutions, though none that hold: nearer than the tangent.
  if (const Sample* sample = ahead.at(length, false)) x = sample->it.x, p = sample->it.p;
  direction = parameter(p) < parameter(state_.p) ? -1 : 1;
  return ahead.problem()->resettled(state_.x, state_.p, x, p);
}

bool Walker::leap(Point& event) {
  for (const double part : leaps) {
    try {
      int direction = 1;
      const std::optional<Transition> found = leap_to(part * step_length_.usual(), direction);
      if (!found) continue;
      const Tangent tangent = first_tangent(*found->problem, found->state, found->p, options_, direction);
      Segment segment(found->problem, options_, found->state, found->p, tangent);
      Sample* sample = segment.at(0.0, true);
      if (!sample) continue;
      segment.add_events(*sample);
      event.before = found->before, event.after = found->after;
      event.precision = std::abs(parameter(found->p) - parameter(state_.p));
      enter_at(segment, *sample);
      return true;
    } catch (const std::domain_error&) {
    } catch (const std::runtime_error&) {
    }
  }
  return false;
}

}  // namespace continuation
