#include "continuation/detect.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "event_by_name.hpp"

namespace continuation {
namespace {

double tolerance(Segment& segment) {
  const Options& options = segment.options();
  return options.location_tolerance *
         std::max(1.0, std::abs(segment.parameter(segment.base())) / options.parameter_scale);
}

// Precision of the parameter from the parameter's values at the bracket's ends, and what rounding of the function adds, as the
// parameter changes from the base to `end`.
double width(Segment& segment, const Bracket& bracket, const Sample& end) {
  const Sample* a = segment.at(bracket.lo, false);
  const Sample* b = segment.at(bracket.hi, false);
  const double change = std::abs(segment.parameter(end) - segment.parameter(segment.base()));
  return (a && b ? std::abs(segment.parameter(*a) - segment.parameter(*b)) : bracket.hi - bracket.lo) +
         bracket.noise * change / std::abs(end.s);
}

// What Newton's method left of the error of a sample, in the parameter: the last increment where it was too small to be
// added; else shrunk as the ones before, or by its own size where it was the first on a fresh factorisation.
double solved_to(const Segment& segment, const Sample& sample) {
  const CorrectorReport& report = sample.report;
  const Options& options = segment.options();
  const double left = StoppingRule(options).negligible(report.increment)
                          ? 1.0
                          : std::min(1.0, std::max(report.contraction, report.increment));
  constexpr double oblique = 2.0;  // a function's zero may cut the branch at an angle
  return options.parameter_scale * oblique * report.increment * left;
}

}  // namespace

int sign_of(const EventSigns& signs, const std::string& name) {
  const auto it = signs.find(name);
  return it == signs.end() || it->second == 0 ? 1 : it->second;
}

bool is_vertical(const Segment& segment, const Sample& lo, const Sample& hi) {
  const double unit = segment.options().parameter_scale;
  constexpr double rounding = 1e-9, slope = 1e-3;
  return (hi.it.p - lo.it.p).cwiseAbs().maxCoeff() <= rounding * unit * std::abs(hi.s - lo.s) &&
         std::max(std::abs(lo.tangent.p), std::abs(hi.tangent.p)) < slope * unit;
}

Located locate_fold(Segment& segment, const Sample& lo, const Sample& hi) {
  const Bracket bracket = find_zero(lo.s, lo.tangent.p, hi.s, hi.tangent.p, tolerance(segment),
                                    [&](double s) -> std::optional<double> {
                                      const Sample* sample = segment.at(s, true);
                                      if (!sample) return std::nullopt;
                                      return sample->tangent.p;
                                    });
  Located fold;
  fold.type = PointType::fold;
  fold.s = bracket.best;
  const Sample* best = segment.at(bracket.best, true);
  fold.sample = best ? *best : lo;
  fold.lo = bracket.lo;
  fold.hi = bracket.hi;
  // p is flat at a fold: its error is half the slope at the end times the bracket.
  const double unit = segment.options().parameter_scale;
  const double slope = std::max(std::abs(fold.sample.tangent.p), unit * (bracket.hi - bracket.lo));
  fold.precision = slope * (bracket.hi - bracket.lo + bracket.noise);
  fold.index = lo.index;
  fold.index_after = hi.index;
  if (!bracket.converged) fold.note = "bracket not converged: " + segment.failure();
  return fold;
}

bool slope_jumps(const Sample& lo, const Sample& hi, const Located& fold) {
  // A slope that is continuous is as small as the bracket, or what rounding leaves of it near a branch point.
  constexpr double jump = 0.01;
  return std::abs(fold.sample.tangent.p) > jump * std::abs(hi.tangent.p - lo.tangent.p) && fold.note.empty();
}

void sharpen_fold(Segment& segment, Located& fold) {
  const Correction left = segment.sharpen(fold.sample);
  // p is stationary along the branch: there an error of the state counts by its square.
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::abs(segment.parameter(fold.sample));
  fold.precision =
      std::max({fold.precision,
                left.parameter + segment.options().parameter_scale * left.length * left.length, rounding});
}

namespace {

/// Of the functions that change sign up to a sample the one whose zero is nearest on the chord, as it is at the base; nullptr: none.
const EventFunction* earliest(const std::vector<EventFunction>& at_base, const Sample& top,
                              const EventSigns& signs, double zero,
                              const std::function<bool(const EventFunction&)>& left_out) {
  const EventFunction* first = nullptr;
  double first_s = top.s;
  for (const EventFunction& event : top.events) {
    const EventFunction* base = find(at_base, event.name);
    if (!base || left_out(event)) continue;
    const int sign = sign_of(signs, event.name);
    const double f_base = sign * base->value, f_top = sign * event.value;
    if (f_top >= -zero) continue;
    const double estimate = f_base <= 0.0 ? 0.0 : top.s * f_base / (f_base - f_top);
    if (!first || estimate < first_s) {
      first = base;
      first_s = estimate;
    }
  }
  return first;
}

}  // namespace

std::optional<Located> locate_first_event(Segment& segment, const Sample& hi, const EventSigns& signs) {
  const double zero = segment.options().event_zero;
  const std::vector<EventFunction>& at_base = segment.base().events;
  const Sample* top = &hi;
  std::optional<Located> found;
  // Functions that vanish close together: where one has its zero in a place that cannot be solved, another comes before it.
  std::vector<Located> unsolved;
  const auto is_unsolved = [&](const EventFunction& event) {
    return std::any_of(unsolved.begin(), unsolved.end(),
                       [&](const Located& other) { return other.event == event.name; });
  };
  for (int round = 0; round < 20; ++round) {
    const EventFunction* first = earliest(at_base, *top, signs, zero, [&](const EventFunction& event) {
      return (found && event.name == found->event) || is_unsolved(event);
    });
    if (!first) {
      // Nothing comes before one that is over by then.
      for (const Located& other : unsolved) {
        const EventFunction* function = find(top->events, other.event);
        if (function && sign_of(signs, other.event) * function->value < -zero) return other;
      }
      return found;
    }
    const std::string name = first->name;
    const int sign = sign_of(signs, name);
    Located event;
    event.type = PointType::event;
    event.event = name;
    event.which = static_cast<std::size_t>(first - at_base.data());
    event.index = segment.base().index;
    if (sign * first->value <= 0.0) {
      event.sample = segment.base();
      return event;
    }
    const auto value = [&](double s) -> std::optional<double> {
      Sample* sample = segment.at(s, false);
      if (!sample) return std::nullopt;
      if (sample->events.empty()) segment.add_events(*sample);
      const EventFunction* function = find(sample->events, name);
      return function ? std::optional(sign * function->value) : std::nullopt;
    };
    const Bracket bracket = find_zero(0.0, sign * first->value, top->s, sign * find(top->events, name)->value,
                                      tolerance(segment), value);
    event.s = bracket.lo;  // the state before the event is the valid one
    Sample* best = segment.at(event.s, false);
    event.sample = best ? *best : segment.base();
    event.lo = bracket.lo;
    event.hi = bracket.hi;
    event.precision = width(segment, bracket, *top) + solved_to(segment, event.sample);
    const double narrow = 1e-5 * segment.options().parameter_scale;
    if (!bracket.converged && (event.precision > narrow || first->passes)) {
      event.note = "bracket not converged: " + segment.failure();
    }
    // A function of the branch is continuous: where it jumps, the two ends lie on two branches.
    const double largest = std::max(std::abs(first->value), std::abs(find(top->events, name)->value));
    const auto at_lo = value(bracket.lo), at_hi = value(bracket.hi);
    constexpr double jump = 1e-2, sharp = 1e-6;
    if (bracket.converged && at_lo && at_hi && bracket.hi - bracket.lo < sharp * top->s &&
        std::max(std::abs(*at_lo), std::abs(*at_hi)) > jump * largest)
      event.note = "the corrector has left the branch: the function jumps";
    if (!bracket.converged) {
      unsolved.push_back(event);
      if (!found) found = std::move(event);
      continue;
    }
    if (found && event.s > found->hi) return found;
    found = std::move(event);
    // Another event may have changed sign before this one.
    Sample* below = segment.at(bracket.lo, false);
    if (!below) return found;
    if (below->events.empty()) segment.add_events(*below);
    top = below;
  }
  return found;
}

std::optional<Located> locate_function(Segment& segment, const UserFunction& function, const Sample& lo,
                                       const Sample& hi) {
  const auto value = [&](const Sample& sample) { return function.value(sample.it.x, sample.it.p); };
  const double f_lo = value(lo), f_hi = value(hi);
  if (!(f_lo != 0.0 && (f_hi == 0.0 || (f_lo < 0.0) != (f_hi < 0.0)))) return std::nullopt;
  const Bracket bracket =
      find_zero(lo.s, f_lo, hi.s, f_hi, tolerance(segment), [&](double s) -> std::optional<double> {
        const Sample* sample = segment.at(s, false);
        if (!sample) return std::nullopt;
        return value(*sample);
      });
  const Sample* best = segment.at(bracket.best, true);
  if (!best) return std::nullopt;
  Located located;
  located.type = PointType::function;
  located.event = function.name;
  located.s = bracket.best;
  located.sample = *best;
  located.lo = bracket.lo;
  located.hi = bracket.hi;
  located.precision = width(segment, bracket, hi) + solved_to(segment, *best);
  located.index = located.index_after = best->index;
  if (!bracket.converged) located.note = "bracket not converged: " + segment.failure();
  return located;
}

}  // namespace continuation
