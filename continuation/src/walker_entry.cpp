// How a walker enters the problem that follows an event, and which way it goes on there.

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "approach.hpp"
#include "continuation/walker.hpp"
#include "event_by_name.hpp"

namespace continuation {

namespace {

// A short step may still be within roundoff of the event, a long one beyond the next.
constexpr std::array parts_of_step{0.1, 0.01, 1e-3, 1e-4, 1e-5};

}  // namespace

// Beyond an event a branch may turn, but not into itself.
bool Walker::leads_back(Problem& next, const Iterate& it, const Tangent& way) const {
  const double length = 0.1 * step_length_.usual();
  Segment ahead(next.clone(), options_, it.x, it.p, way);
  Segment behind(state_.problem->clone(), options_, state_.x, state_.p,
                 Tangent{-state_.tangent.x, -state_.tangent.p});
  const Sample* there = ahead.at(length, false);
  const Sample* far = there ? behind.at(length, false) : nullptr;
  if (!far) return false;
  // As far as the branch has been: right before the event it may have turned, and go on as it came.
  const double rise = ahead.parameter(*there) - parameter(state_.p),
               back = behind.parameter(*far) - parameter(state_.p);
  if (rise * back <= 0.0 || std::abs(rise) > std::abs(back)) return false;
  const Sample* same = behind.at_parameter(ahead.parameter(*there), behind.base(), *far, false);
  if (!same) return false;
  Problem &now = *ahead.problem(), &before = *behind.problem();
  const Vector found = now.fingerprint(there->it.x, there->it.p),
               known = before.fingerprint(same->it.x, same->it.p),
               here = before.fingerprint(state_.x, state_.p);
  if (found.size() != known.size()) return false;
  // In all that changes along the branch; how many contacts there are, say, does not.
  constexpr double next_to_way = 0.01, rounding = 1e-9;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const double way_of_it = std::abs(known(i) - here(i));
    if (way_of_it > rounding && std::abs(found(i) - known(i)) > next_to_way * way_of_it) return false;
  }
  return true;
}

// Corrects the new problem's state at p, or slightly beyond, and finds the direction in which it is valid.
bool Walker::enter(const Transition& transition, int direction, const std::string& passed,
                   std::string& failure) {
  const std::shared_ptr<Problem>& problem = transition.problem;
  const double here = state_.p[options_.parameter];
  Approach approach(*problem, transition.state, state_.p, options_);
  const std::vector<double> values =
      approach.values(transition, direction, step_length_.current() * options_.parameter_scale);
  failure = "the new problem has no solution here";
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double value = values[k];
    Iterate it;
    const CorrectorReport report = approach.solve_at(value, it, k + 1 == values.size());
    if (!report.converged) {
      if (value == here && k + 1 < values.size())
        failure = "the new problem cannot be solved: " + report.failure;
      continue;
    }
    try {
      for (const auto& [sign, tangent, valid] : ways_along(transition, it, direction, passed)) {
        if (valid == 0.0) {
          failure = "the new problem is not valid in either direction";
          continue;
        }
        if (sign != direction && leads_back(*problem, it, tangent)) {
          failure = "what follows is the branch that led here";
          return false;
        }
        Segment segment(problem, options_, it.x, it.p, tangent);
        Sample* sample = segment.at(0.0, true);
        if (!sample) {
          failure = segment.failure();
          continue;
        }
        segment.add_events(*sample);
        enter_at(segment, *sample);
        return true;
      }
    } catch (const std::domain_error& error) {
      failure = error.what();
    } catch (const std::runtime_error& error) {
      failure = error.what();
    }
  }
  return false;
}

// Goes on from a state beyond an event.
void Walker::enter_at(Segment& segment, Sample& sample) {
  // Signs are read off the first point beyond: here the function that changed, and its mirror image, are zero up to roundoff.
  // Those that are not, or may have either sign, are known from here on.
  state_.signs.clear();
  settle(segment, sample);
  forget_rounded_signs(false);
  state_.mesh_changed = true;
  state_.previous_tangent = state_.tangent;
  // A short first step separates the zero just passed from the next event.
  step_length_.reset(0.1 * step_length_.usual());
}

// A function that is zero up to rounding at the point of an event has no sign there, unless it may have either.
// @param negative  those that are negative beyond rounding have theirs: not so where they are still to be passed
void Walker::forget_rounded_signs(bool negative) {
  const double zero = rounded_zero();
  std::erase_if(state_.signs, [&](const auto& sign) {
    return std::none_of(state_.events.begin(), state_.events.end(), [&](const EventFunction& event) {
      const bool known = event.passes || event.value > zero || (negative && event.value < -zero);
      return known && event.name == sign.first;
    });
  });
}

// Within roundoff of the event, or of where touches laid anew have it, either way may hold: the one that holds longer comes first.
std::array<Walker::Way, 2> Walker::ways_along(const Transition& transition, const Iterate& it, int direction,
                                              const std::string& passed) {
  const auto way = [&](int sign) {
    Way out{sign, first_tangent(*transition.problem, it.x, it.p, options_, sign), 0.0};
    if (transition.silent)  // the same curve, described otherwise: the parameter goes the same way
      out.valid = sign == direction ? 1.0 : 0.0;
    else
      out.valid = valid_over(transition.problem, it.x, it.p, out.tangent, passed);
    return out;
  };
  std::array<Way, 2> out{way(direction), Way{-direction, {}, 0.0}};
  if (out[0].valid >= parts_of_step.front()) return out;  // none can hold longer
  out[1] = way(-direction);
  if (out[1].valid > out[0].valid) std::swap(out[0], out[1]);
  return out;
}

double Walker::valid_over(const std::shared_ptr<Problem>& problem, const Vector& x, const Vector& p,
                          const Tangent& tangent, const std::string& passed) {
  // Of mirror images that vanish together one is passed now, the others, negative from here on, in the next
  // steps. They have the value of the one passed; others are merely small.
  const EventFunction* now = find(state_.events, passed);
  const double left = now ? now->value : 0.0;
  const auto simultaneous =
      std::count_if(state_.events.begin(), state_.events.end(), [&](const EventFunction& event) {
        return event.name != passed && !event.passes &&
               std::abs(event.value - left) <= 10.0 * options_.event_zero + 0.1 * std::abs(left);
      });
  for (const double part : parts_of_step) {
    Segment segment(problem, options_, x, p, tangent);
    Sample* sample = segment.at(part * step_length_.current(), false);
    if (!sample) continue;
    segment.add_events(*sample);
    const auto negative =
        std::count_if(sample->events.begin(), sample->events.end(), [&](const EventFunction& event) {
          if (event.passes || event.value >= -options_.event_zero) return false;
          const EventFunction* before = find(state_.events, event.name);
          // Negative already before the event, so not the event's doing.
          return !before || before->value >= -1e3 * options_.event_zero;
        });
    const bool valid = negative <= simultaneous;
    if (valid) return part;
  }
  return 0.0;
}

}  // namespace continuation
