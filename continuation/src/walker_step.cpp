// One step of a walker: predictor, corrector, and what lies between the two points.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "continuation/walker.hpp"

namespace continuation {

// Has the corrector left the branch? Two measures, both of the end (u, Δp) in units of the step: its distance from the
// tangent, which is tan(θ/2) on a circle that turns by θ, and its distance from where the mean of the two tangents leads,
// which is θ'/6 where the curvature changes by as much as turns the tangent by θ'.
bool Walker::leaves_branch(const Segment& segment, const Sample& end, std::string& failure) const {
  const Problem& problem = *state_.problem;
  const Scales scale = options_.scales();
  const Tangent &from = state_.tangent, &to = end.tangent;
  const double cosine = inner(problem, from, to, scale);
  if (cosine < std::cos(options_.max_angle)) return failure = "the tangent turns too much", true;
  const auto distance = [&](const Tangent& direction, double length) {
    const Tangent off{end.it.u - length * direction.x, end.it.y[0] - length * direction.p};
    return std::sqrt(inner(problem, off, off, scale)) / end.s;
  };
  if (distance(from, end.s) > std::tan(0.5 * options_.max_angle))
    return failure = "the corrector leads too far from the tangent", true;
  const Tangent sum{from.x + to.x, from.p + to.p};
  if (distance(sum, end.s / (1.0 + cosine)) > std::tan(options_.max_angle / 6.0))
    return failure = "the corrector has left the branch: the tangents do not lead from point to point", true;
  const double rise = segment.parameter(end) - parameter(state_.p);
  if (!is_vertical(segment, segment.base(), end) && from.p * to.p > 0.0 && rise * from.p < 0.0 &&
      std::abs(rise) > 1e-9 * options_.parameter_scale * end.s && 0.5 * end.s >= options_.step_min)
    return failure = "two folds in one step", true;
  return false;
}

// By the last two tangents, where they tell of a step this long. A step that failed is tried again along the tangent.
std::optional<Tangent> Walker::curvature(double ds) const {
  const Tangent &from = state_.previous_tangent, &to = state_.tangent;
  if (step_length_.after_rejection() || !(state_.last_ds > 0.0) || from.x.size() != to.x.size())
    return std::nullopt;
  Tangent bend{(to.x - from.x) / state_.last_ds, (to.p - from.p) / state_.last_ds};
  const double turn = ds * std::sqrt(inner(*state_.problem, bend, bend, options_.scales()));
  if (!(turn < options_.max_angle)) return std::nullopt;
  return bend;
}

// What is seen in a step so long may be a jump, and is looked at again in a shorter one. Branches that come closer to each
// other than the rest cannot be told apart.
bool Walker::long_step(double ds) const {
  constexpr double many = 100.0;
  return 0.5 * ds >= many * options_.step_min;
}

bool Walker::advance_once(std::string& failure) {
  Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
  Sample& base = segment.base();
  base.complete = true;
  base.index = state_.index;
  base.complex_index = state_.complex_index;
  base.breaking_index = state_.breaking_index;
  base.determinant = state_.determinant;
  base.small = state_.small;
  base.events = state_.events;
  if (const std::optional<Tangent> bend = curvature(step_length_.current())) segment.bend(*bend);
  Sample* end = segment.at(step_length_.current(), true);
  if (!end) return failure = segment.failure(), false;
  if (leaves_branch(segment, *end, failure)) return false;
  std::optional<Located> turn;
  if ((options_.detect_folds || options_.detect_branch_points) && !is_vertical(segment, base, *end) &&
      state_.tangent.p * end->tangent.p < 0.0)
    turn = locate_fold(segment, base, *end);
  // A walk that begins at a fold has it behind it: there the sign of the slope is rounding's.
  if (turn && state_.points <= 1 && turn->s <= 10.0 * options_.location_tolerance) turn.reset();
  if (turn && long_step(end->s) && slope_jumps(base, *end, *turn))
    return failure = "the corrector has left the branch: the parameter's slope jumps", false;
  const CorrectorReport report = end->report;
  End reason;
  std::optional<Located> event;
  if (!shorten(segment, end, turn ? &*turn : nullptr, reason, event, failure)) return false;
  std::vector<Located> specials;
  if (!find_functions(segment, end, reason, event, specials, failure)) return false;
  if (turn && turn->s >= end->s) turn.reset();
  if (end->s > 0.0 &&
      !find_specials(segment, *end, turn ? &*turn : nullptr, event.has_value(), specials, failure))
    return false;
  for (const Located& located : specials) queue_.push_back(special(segment, located));

  if (event) {
    Point point = special(segment, *event);
    state_.events_in_place = event->s > 1e-6 * options_.step_min + 1e-12 ? 0 : state_.events_in_place + 1;
    if (event->s > 0.0) settle(segment, *end);
    ++state_.points;
    const double met = point.p[options_.parameter];
    settle_event(point, event->event);
    pass(std::move(point), event->which, event->event, state_.tangent.p < 0.0 ? -1 : 1, met);
    return true;
  }
  accept(segment, *end, report, reason);
  return true;
}

// Folds, branch points and Hopf points between the base and `end`, in the order of the branch; false where the step must be refused.
bool Walker::find_specials(Segment& segment, const Sample& end, const Located* turn, bool at_event,
                           std::vector<Located>& specials, std::string& failure) {
  Crossings crossings;
  std::vector<Located> breaking;
  if (options_.detect_branch_points) {
    const bool may_refuse = long_step(end.s);
    const double edge = at_event ? end.s : std::numeric_limits<double>::infinity();
    crossings = locate_crossings(segment, segment.base(), end, turn, edge, may_refuse);
    if (!crossings.refusal.empty()) return failure = crossings.refusal, false;
    const bool crossed = std::any_of(crossings.points.begin(), crossings.points.end(),
                                     [](const Located& l) { return l.type == PointType::branch_point; });
    if (turn && !crossings.fold && !crossed && may_refuse)
      return failure = "the parameter turns without a fold or a branch point", false;
    breaking = locate_symmetry_breaking(segment, segment.base(), end, crossings.points);
  } else {
    crossings.fold = true;
  }
  std::vector<Located> found = std::move(crossings.points);
  std::move(breaking.begin(), breaking.end(), std::back_inserter(found));
  // Where an event function vanishes the equations it belongs to may become singular with it: the branch that crosses
  // there is not of this problem's. Nor is a count that changes in a bracket that reaches up to the event and was not narrowed.
  const double p = segment.parameter(end);
  if (at_event)
    std::erase_if(found, [&](const Located& l) {
      return std::abs(segment.parameter(l.sample) - p) <
                 1e-8 * std::max(options_.parameter_scale, std::abs(p)) ||
             (l.type == PointType::branch_point && !l.branch_point && l.hi >= end.s);
    });
  if (turn && crossings.fold && options_.detect_folds) {
    Located fold = *turn;
    try {
      sharpen_fold(segment, fold);
    } catch (const std::domain_error& error) {
      return failure = error.what(), false;
    } catch (const std::runtime_error& error) {
      return failure = error.what(), false;
    }
    found.push_back(std::move(fold));
  }
  std::move(found.begin(), found.end(), std::back_inserter(specials));
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
