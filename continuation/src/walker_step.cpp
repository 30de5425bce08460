// One step of a walker: predictor, corrector, and what lies between the two points.

#include <algorithm>
#include <cmath>
#include <iterator>
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
    if (before == state_.previous_events.end() || event.passes || event.value < 0.0) continue;
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

bool Walker::advance_once(std::string& failure) {
  Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
  segment.base().complete = true;
  segment.base().index = state_.index;
  segment.base().breaking_index = state_.breaking_index;
  segment.base().determinant = state_.determinant;
  segment.base().events = state_.events;
  const double ds = step_length_.current();
  Sample* end = segment.at(ds, true);
  if (!end) return failure = segment.failure(), false;
  const double cosine = inner(*state_.problem, state_.tangent, end->tangent, options_.parameter_scale);
  if (cosine < std::cos(options_.max_angle)) return failure = "the tangent turns too much", false;
  const double rise = segment.parameter(*end) - parameter(state_.p);
  const bool vertical = is_vertical(segment.base(), *end);
  const double turn = vertical ? 0.0 : state_.tangent.p * end->tangent.p;
  if (turn > 0.0 && rise * state_.tangent.p < 0.0 && std::abs(rise) > 1e-9 * ds &&
      0.5 * ds >= options_.step_min)
    return failure = "two folds in one step", false;

  std::optional<Located> fold;
  if (options_.detect_folds && turn < 0.0) fold = locate_fold(segment, segment.base(), *end);
  const CorrectorReport report = end->report;
  End reason;
  if (!limit(segment, end, fold ? &*fold : nullptr, reason)) return failure = segment.failure(), false;
  bool truncated = static_cast<bool>(reason);
  if (!truncated && options_.detect_closed) {
    if (Sample* closing = close(segment, *end, fold ? &*fold : nullptr)) {
      end = closing;
      reason = End{End::Kind::closed, "closed: the branch is back at its start"};
      truncated = true;
    }
  }
  segment.add_events(*end);
  std::optional<Located> event;
  if (options_.detect_events) event = locate_first_event(segment, *end, state_.signs);
  if (event) {
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
  }
  if (fold && fold->s >= end->s) fold.reset();
  std::vector<Located> specials;
  if (options_.detect_branch_points && end->s > 0.0)
    specials = locate_branch_points(segment, segment.base(), *end);
  std::vector<Located> breaking;
  if (options_.detect_branch_points && end->s > 0.0)
    breaking = locate_symmetry_breaking(segment, segment.base(), *end, specials);
  // Where an event function vanishes the equations it belongs to may become singular with it: the branch that crosses
  // there is not of this problem's.
  const auto at_the_event = [&](const Located& l) {
    const double p = segment.parameter(*end);
    return std::abs(segment.parameter(l.sample) - p) < 1e-8 * std::max(1.0, std::abs(p));
  };
  if (event) std::erase_if(specials, at_the_event), std::erase_if(breaking, at_the_event);
  if (fold) {
    // On the side branch of a pitchfork dp/ds vanishes at the branch point: that is not a fold.
    const double close_by = 1e-4 * ds + 1e-7;
    const bool is_branch_point = std::any_of(specials.begin(), specials.end(), [&](const Located& l) {
      return std::abs(l.s - fold->s) < close_by;
    });
    if (!is_branch_point) specials.push_back(std::move(*fold));
  }
  std::move(breaking.begin(), breaking.end(), std::back_inserter(specials));
  std::sort(specials.begin(), specials.end(), [](const Located& a, const Located& b) { return a.s < b.s; });
  for (const Located& located : specials) queue_.push_back(special(segment, located));

  if (event) {
    Point point = special(segment, *event);
    state_.events_in_place = event->s > 1e-6 * options_.step_min + 1e-12 ? 0 : state_.events_in_place + 1;
    if (event->s > 0.0) settle(segment, *end);
    ++state_.points;
    pass(std::move(point), event->which, event->event, state_.tangent.p < 0.0 ? -1 : 1);
    return true;
  }
  const double ds_taken = end->s;
  const int iterations = end->report.iterations;
  settle(segment, *end);
  ++state_.points;
  state_.events_in_place = 0;
  if (reason) {
    pending_end_ = reason;
  } else {
    step_length_.accepted(report.iterations, report.contraction);
    // A start at a fold is never crossed transversely in p: its neighbour stands in for it.
    if (state_.points == 2 && std::abs(state_.start_slope) < 0.1) remember_start();
  }
  adapt();  // first, so that every point is yielded on a discretisation that suits it
  if (state_.end) return true;
  Point point = here(reason ? PointType::end : PointType::regular);
  point.ds = ds_taken;
  point.newton_iterations = iterations;
  queue_.push_back(std::move(point));
  return true;
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
  if (comparable && rms(state_.x - state_.start_x) > 3.0 * rms(end.it.x - state_.x) + 1e-3) return nullptr;
  Sample* sample = segment.at_parameter(state_.start_parameter, lo, hi, true);
  if (!sample || sample->s < 0.0 || sample->s > end.s) return nullptr;
  if (comparable && rms(sample->it.x - state_.start_x) <= 1e-6 * std::max(1.0, rms(state_.start_x)))
    return sample;
  if (comparable) return nullptr;
  const Vector now = state_.problem->fingerprint(sample->it.x, sample->it.p);
  // Another mesh: equal only within its error.
  const bool same =
      now.size() == state_.start_fingerprint.size() &&
      rms(now - state_.start_fingerprint) <= 1e-5 * std::max(1.0, rms(state_.start_fingerprint));
  return same ? sample : nullptr;
}

Point Walker::special(Segment& segment, const Located& located) {
  Point point;
  point.breaking = located.problem != nullptr;
  point.problem = (located.problem ? located.problem : segment.problem())->clone();
  point.x = located.sample.it.x;
  point.p = located.sample.it.p;
  point.tangent = located.sample.tangent.x.size() > 0 ? located.sample.tangent : state_.tangent;
  point.type = located.type;
  point.path_length = state_.path_length + located.s;
  point.ds = located.s;
  point.newton_iterations = located.sample.report.iterations;
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
