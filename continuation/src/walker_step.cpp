// One step of a walker: predictor, corrector, and what lies between the two points.

#include <algorithm>
#include <cmath>
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
  if (!options_.detect_events || !(last_ds_ > 0.0)) return false;
  const double reach = 100.0 * options_.step_min;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const EventFunction& event = events_[i];
    const auto before = std::find_if(previous_events_.begin(), previous_events_.end(),
                                     [&](const EventFunction& other) { return other.name == event.name; });
    if (before == previous_events_.end() || event.value < 0.0) continue;
    const double rate = (event.value - before->value) / last_ds_;
    if (event.value + rate * reach >= 0.0) continue;
    Segment segment(problem_, options_, x_, p_, tangent_);
    Located located;
    located.type = PointType::event;
    located.event = event.name;
    located.which = i;
    located.sample = segment.base();
    located.index = index_;
    located.hi = -event.value / rate;
    located.precision = located.hi;
    located.note = "at the edge of the domain of F, extrapolated";
    Point point = special(segment, located);
    ++events_in_place_;
    ++points_;
    pass(std::move(point), i, event.name, tangent_.p < 0.0 ? -1 : 1);
    return true;
  }
  return false;
}

bool Walker::advance_once(std::string& failure) {
  Segment segment(problem_, options_, x_, p_, tangent_);
  segment.base().complete = true;
  segment.base().index = index_;
  segment.base().determinant = determinant_;
  segment.base().events = events_;
  const double ds = step_length_.current();
  Sample* end = segment.at(ds, true);
  if (!end) return failure = segment.failure(), false;
  const double cosine = inner(*problem_, tangent_, end->tangent, options_.parameter_scale);
  if (cosine < std::cos(options_.max_angle)) return failure = "the tangent turns too much", false;
  const double rise = segment.parameter(*end) - parameter(p_);
  const double turn = tangent_.p * end->tangent.p;
  if (turn > 0.0 && rise * tangent_.p < 0.0 && std::abs(rise) > 1e-9 * ds && 0.5 * ds >= options_.step_min)
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
  if (options_.detect_events) event = locate_first_event(segment, *end, signs_);
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
  if (fold) {
    // On the side branch of a pitchfork dp/ds vanishes at the branch point: that is not a fold.
    const double close_by = 1e-4 * ds + 1e-7;
    const bool is_branch_point = std::any_of(specials.begin(), specials.end(), [&](const Located& l) {
      return std::abs(l.s - fold->s) < close_by;
    });
    if (!is_branch_point) specials.push_back(std::move(*fold));
  }
  std::sort(specials.begin(), specials.end(), [](const Located& a, const Located& b) { return a.s < b.s; });
  for (const Located& located : specials) queue_.push_back(special(segment, located));

  if (event) {
    Point point = special(segment, *event);
    events_in_place_ = event->s > 1e-6 * options_.step_min + 1e-12 ? 0 : events_in_place_ + 1;
    if (event->s > 0.0) settle(segment, *end);
    ++points_;
    pass(std::move(point), event->which, event->event, tangent_.p < 0.0 ? -1 : 1);
    return true;
  }
  Point point;
  point.ds = end->s;
  point.newton_iterations = end->report.iterations;
  settle(segment, *end);
  ++points_;
  events_in_place_ = 0;
  point.problem = problem_;
  point.x = x_;
  point.p = p_;
  point.tangent = tangent_;
  point.index = point.index_after = index_;
  point.path_length = path_length_;
  if (reason) {
    point.type = PointType::end;
    pending_end_ = reason;
  } else {
    step_length_.accepted(report.iterations, report.contraction);
    adapt_pending_ = true;
    // A start at a fold is never crossed transversely in p: its neighbour stands in for it.
    if (points_ == 2 && std::abs(start_slope_) < 0.1) remember_start();
  }
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
  if (points_ < 4) return nullptr;
  Sample& middle = fold ? fold->sample : end;
  const bool first_half = tangent_.p * start_slope_ > 0.0;
  if (!first_half && (!fold || end.tangent.p * start_slope_ <= 0.0)) return nullptr;
  Sample& lo = first_half ? segment.base() : middle;
  Sample& hi = first_half ? middle : end;
  if (!crosses(segment, lo, hi, start_parameter_)) return nullptr;
  const bool comparable = !mesh_changed_;
  if (comparable && rms(x_ - start_x_) > 3.0 * rms(end.it.x - x_) + 1e-3) return nullptr;
  Sample* sample = segment.at_parameter(start_parameter_, lo, hi, true);
  if (!sample || sample->s < 0.0 || sample->s > end.s) return nullptr;
  if (comparable && rms(sample->it.x - start_x_) <= 1e-6 * std::max(1.0, rms(start_x_))) return sample;
  if (comparable) return nullptr;
  const Vector now = problem_->fingerprint(sample->it.x, sample->it.p);
  // Another mesh: equal only within its error.
  const bool same = now.size() == start_fingerprint_.size() &&
                    rms(now - start_fingerprint_) <= 1e-5 * std::max(1.0, rms(start_fingerprint_));
  return same ? sample : nullptr;
}

Point Walker::special(Segment& segment, const Located& located) {
  Point point;
  point.problem = segment.problem()->clone();
  point.x = located.sample.it.x;
  point.p = located.sample.it.p;
  point.tangent = located.sample.tangent.x.size() > 0 ? located.sample.tangent : tangent_;
  point.type = located.type;
  point.path_length = path_length_ + located.s;
  point.ds = located.s;
  point.newton_iterations = located.sample.report.iterations;
  point.index = located.index;
  point.index_after = located.index_after;
  point.event = located.event;
  point.note = located.note;
  point.precision = located.precision;
  point.bracket_lo = path_length_ + located.lo;
  point.bracket_hi = path_length_ + located.hi;
  point.multiplicity = located.multiplicity;
  if (located.branch_point) point.branch_point = std::make_shared<const BranchPoint>(*located.branch_point);
  switch (located.type) {
    case PointType::fold:
      point.label = "F" + std::to_string(++folds_);
      break;
    case PointType::branch_point:
      point.label = "B" + std::to_string(++branch_points_);
      break;
    default:
      point.label = "E" + std::to_string(++event_points_);
  }
  return point;
}

}  // namespace continuation
