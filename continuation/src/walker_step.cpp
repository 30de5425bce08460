// One step of a walker: predictor, corrector, and what lies between the two points.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "continuation/walker.hpp"

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

}  // namespace

// F may not exist beyond an event (a length below zero): then steps fail all the way to it. An event
// function that vanishes within a few smallest steps, going on as between the last two points, is taken to
// have its zero here.
bool Walker::event_at_edge() {
  if (!options_.detect_events || !(state_.last_ds > 0.0)) return false;
  const double reach = 100.0 * options_.step_min;
  for (std::size_t i = 0; i < state_.events.size(); ++i) {
    const EventFunction& event = state_.events[i];
    const auto before = std::find_if(state_.previous_events.begin(), state_.previous_events.end(),
                                     [&](const EventFunction& other) { return other.name == event.name; });
    if (before == state_.previous_events.end() || event.value < 0.0) continue;
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
    pass(std::move(point), i, event.name, state_.tangent.p < 0.0 ? -1 : 1);
    return true;
  }
  return false;
}

// Has the corrector left the branch? Two measures, both of the end (u, Δp) in units of the step: its distance from the
// tangent, which is tan(θ/2) on a circle that turns by θ, and its distance from where the mean of the two tangents leads,
// which is θ'/6 where the curvature changes by as much as turns the tangent by θ'.
bool Walker::leaves_branch(const Segment& segment, const Sample& end, std::string& failure) const {
  const Problem& problem = *state_.problem;
  const Scales scales = options_.scales();
  const Tangent &from = state_.tangent, &to = end.tangent;
  const double cosine = inner(problem, from, to, scales);
  if (cosine < std::cos(options_.max_angle)) return failure = "the tangent turns too much", true;
  const auto distance = [&](const Tangent& direction, double length) {
    const Tangent off{end.it.u - length * direction.x, end.it.y[0] - length * direction.p};
    return std::sqrt(inner(problem, off, off, scales)) / end.s;
  };
  if (distance(from, end.s) > std::tan(0.5 * options_.max_angle))
    return failure = "the corrector leaves the tangent too far", true;
  const Tangent sum{from.x + to.x, from.p + to.p};
  if (distance(sum, end.s / (1.0 + cosine)) > std::tan(options_.max_angle / 6.0))
    return failure = "the corrector has left the branch: the tangents do not lead from point to point", true;
  const double rise = segment.parameter(end) - parameter(state_.p);
  if (!is_vertical(segment, segment.samples().front(), end) && from.p * to.p > 0.0 && rise * from.p < 0.0 &&
      std::abs(rise) > 1e-9 * options_.parameter_scale * end.s && 0.5 * end.s >= options_.step_min)
    return failure = "two folds in one step", true;
  return false;
}

bool Walker::advance_once(std::string& failure) {
  Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
  Sample& base = segment.base();
  base.complete = true;
  base.index = state_.index;
  base.complex_index = state_.complex_index;
  base.determinant = state_.determinant;
  base.events = state_.events;
  const double ds = step_length_.current();
  Sample* end = segment.at(ds, true);
  if (!end) return failure = segment.failure(), false;
  if (leaves_branch(segment, *end, failure)) return false;
  const bool turns = !is_vertical(segment, base, *end) && state_.tangent.p * end->tangent.p < 0.0;

  std::optional<Located> turn;
  if ((options_.detect_folds || options_.detect_branch_points) && turns)
    turn = locate_fold(segment, base, *end);
  const CorrectorReport report = end->report;
  End reason;
  std::optional<Located> event;
  if (!shorten(segment, end, turn ? &*turn : nullptr, reason, event, failure)) return false;
  if (turn && turn->s >= end->s) turn.reset();
  std::vector<Located> specials;
  for (const UserFunction& function : options_.functions) {
    std::optional<Located> zero = locate_function(segment, function, base, *end);
    if (!zero) continue;
    if (function.stop) {
      end = segment.at(zero->s, true);
      if (!end) return failure = segment.failure(), false;
      if (end->events.empty()) segment.add_events(*end);
      reason = End{End::Kind::function, function.name + " is zero"};
      event.reset();
    }
    specials.push_back(std::move(*zero));
  }
  if (turn && turn->s >= end->s) turn.reset();
  std::erase_if(specials, [&](const Located& l) { return l.s > end->s; });
  if (end->s > 0.0 &&
      !find_specials(segment, *end, turn ? &*turn : nullptr, event.has_value(), specials, failure))
    return false;
  for (const Located& located : specials) queue_.push_back(special(segment, located));
  if (event) {
    Point point = special(segment, *event);
    state_.events_in_place = event->s > 1e-6 * options_.step_min + 1e-12 ? 0 : state_.events_in_place + 1;
    if (event->s > 0.0) settle(segment, *end);
    ++state_.points;
    pass(std::move(point), event->which, event->event, state_.tangent.p < 0.0 ? -1 : 1);
    return true;
  }
  accept(segment, *end, report, reason);
  return true;
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
  if (options_.detect_events) event = locate_first_event(segment, *end, state_.signs);
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

// Folds, branch points and Hopf points between the base and `end`, in the order of the branch; false where the step must
// be refused.
bool Walker::find_specials(Segment& segment, const Sample& end, Located* turn, bool at_event,
                           std::vector<Located>& specials, std::string& failure) {
  Crossings crossings;
  if (options_.detect_branch_points) {
    constexpr double many =
        100.0;  // step_min: the gap beside an imperfect crossing that is seen as one is wider
    const bool may_refuse = 0.5 * end.s >= many * options_.step_min;
    const double edge = at_event ? end.s : std::numeric_limits<double>::infinity();
    crossings = locate_crossings(segment, segment.base(), end, turn, edge, may_refuse);
    if (!crossings.refusal.empty()) return failure = crossings.refusal, false;
    if (turn && !crossings.fold && may_refuse &&
        std::none_of(crossings.points.begin(), crossings.points.end(),
                     [](const Located& l) { return l.type == PointType::branch_point; }))
      return failure = "the parameter turns without a fold or a branch point", false;
  } else {
    crossings.fold = true;
  }
  // Where an event function vanishes the equations it belongs to may become singular with it: the branch that crosses
  // there is not of this problem's.
  if (at_event)
    std::erase_if(crossings.points, [&](const Located& l) {
      const double p = segment.parameter(end);
      return std::abs(segment.parameter(l.sample) - p) <
             1e-8 * std::max(options_.parameter_scale, std::abs(p));
    });
  std::move(crossings.points.begin(), crossings.points.end(), std::back_inserter(specials));
  if (turn && crossings.fold && options_.detect_folds) {
    Located fold = std::move(*turn);
    try {
      fold.precision = std::max(fold.precision, segment.sharpen(fold.sample));
    } catch (const std::domain_error& error) {
      return failure = error.what(), false;
    } catch (const std::runtime_error& error) {
      return failure = error.what(), false;
    }
    specials.push_back(std::move(fold));
  }
  std::sort(specials.begin(), specials.end(), [](const Located& a, const Located& b) { return a.s < b.s; });
  return true;
}

// Takes the end of a step as the next point.
void Walker::accept(Segment& segment, Sample& end, const CorrectorReport& report, const End& reason) {
  const double ds = end.s;
  const int iterations = end.report.iterations;
  settle(segment, end);
  ++state_.points;
  state_.events_in_place = 0;
  if (reason) {
    pending_end_ = reason;
  } else {
    step_length_.accepted(report.iterations, report.contraction);
    // A start at a fold is never crossed transversely in p: its neighbour stands in for it.
    if (state_.points == 2 && std::abs(state_.start_slope) < 0.1 * options_.parameter_scale) remember_start();
  }
  adapt();  // first, so that every point is yielded on a discretisation that suits it
  if (state_.end) return;
  Point point = here(reason ? PointType::end : PointType::regular);
  point.ds = ds;
  point.newton_iterations = iterations;
  queue_.push_back(std::move(point));
}

// Shortens the step to where p meets a stop value, if it does; false where that solution cannot be found.
bool Walker::limit(Segment& segment, Sample*& end, Located* fold, End& reason) {
  const std::pair<double, const char*> stops[] = {
      {options_.target, "target"}, {options_.lower, "lower bound"}, {options_.upper, "upper bound"}};
  Sample* last = end;
  const auto check = [&](const Sample& lo, Sample& hi) {
    for (const auto& [value, what] : stops) {
      if (!crosses(segment, lo, hi, value)) continue;
      Sample* sample = segment.at_parameter(value, lo, hi, true);
      if (!sample || sample->s < lo.s || sample->s > hi.s) {
        const Bracket bracket =
            find_zero(lo.s, segment.parameter(lo) - value, hi.s, segment.parameter(hi) - value, 1e-12,
                      [&](double s) -> std::optional<double> {
                        const Sample* middle = segment.at(s, false);
                        if (!middle) return std::nullopt;
                        return segment.parameter(*middle) - value;
                      });
        sample = segment.at(bracket.best, true);
        if (!bracket.converged || !sample) return false;
      }
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

Point Walker::special(Segment& segment, const Located& located) {
  Point point;
  point.problem = segment.problem()->clone();
  point.x = located.sample.it.x;
  point.p = located.sample.it.p;
  point.tangent = located.sample.tangent.x.size() > 0 ? located.sample.tangent : state_.tangent;
  point.type = located.type;
  point.path_length = state_.path_length + located.s;
  point.ds = located.s;
  point.newton_iterations = located.sample.report.iterations;
  point.functions = function_values(point.x, point.p);
  point.index = located.index;
  point.index_after = located.index_after;
  point.event = located.event;
  point.note = located.note;
  point.precision = located.precision;
  point.bracket_lo = state_.path_length + located.lo;
  point.bracket_hi = state_.path_length + located.hi;
  point.multiplicity = located.multiplicity;
  if (located.branch_point) point.branch_point = std::make_shared<const BranchPoint>(*located.branch_point);
  return point;
}

}  // namespace continuation
