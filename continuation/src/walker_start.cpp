// The first point of a branch: regular, or right on a fold or a branch point.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "approach.hpp"
#include "continuation/corrector.hpp"
#include "continuation/walker.hpp"

namespace continuation {
namespace {

// A tangent that leans this much towards x belongs to a state that is a fold or a branch point to within rounding.
constexpr double kSingular = 1e7;
// How far from the guess, in the metric, the singular point may be for which it was meant.
constexpr double kNear = 1e-4;

Tangent oriented(Tangent tangent, int direction) {
  if (tangent.p * direction >= 0.0) return tangent;
  return Tangent{-tangent.x, -tangent.p};
}

}  // namespace

void Walker::start() {
  state_.started = true;
  std::string failure;
  // A state that is singular but neither fold nor branch point starts like any other, if it can.
  const bool on_singular = !start_regular(false, failure);
  const bool beside = start_beside_event(on_singular);
  if (on_singular && !beside && !start_singular() && !start_regular(true, failure))
    return lose("no solution at the start: " + failure);
  forget_rounded_signs(true);  // it may be the point of an event
  // On a fold or branch point index and determinant are rounding.
  constexpr double vertical = 1e-6;
  const bool singular =
      on_singular || beside || std::abs(state_.tangent.p) < vertical * options_.parameter_scale;
  if (singular) state_.index = -1, state_.complex_index = state_.determinant = 0;
  state_.points = 1;
  state_.previous_tangent = state_.tangent;
  remember_start();
  Point point = here(PointType::start);
  if (options_.detect_branch_points && !singular && state_.index < 0 && state_.determinant == 0)
    point.note = "branch points are not looked for: the problem gives neither index nor determinant_sign";
  queue_.push_front(std::move(point));
}

// @param anyhow  also where J is singular
bool Walker::start_regular(bool anyhow, std::string& failure) {
  const std::shared_ptr<Problem>& problem = state_.problem;
  try {
    Vector x = state_.x;
    Tangent tangent = state_.tangent;
    if (!state_.has_tangent) {
      const Borders fixed = fixed_parameter(*problem, options_);
      Iterate it{x, Vector::Zero(problem->size()), state_.p, Vector::Zero(1)};
      Options patient = options_;  // a cold start deserves more corrections than a step
      patient.max_newton = std::max(options_.max_newton, 20);
      const CorrectorReport report = correct(*problem, fixed, it, patient);
      if (!report.converged) return failure = report.failure, false;
      double lean = 0.0;
      tangent = first_tangent(*problem, it.x, state_.p, options_, options_.direction, &lean);
      if (lean > kSingular && !anyhow) return failure = "the state is singular", false;
      x = it.x;
    }
    Segment segment(problem, options_, x, state_.p, tangent);
    segment.base().complete = false;
    Sample* sample = segment.at(0.0, true);
    if (!sample) return failure = segment.failure(), false;
    // On a branch point the matrix is singular, and what it gives lies at right angles to the tangent: only the one that
    // was given says which way to go.
    constexpr double right_angle = 1e-3;
    if (!anyhow && inner(*problem, tangent, sample->tangent, options_.scales()) < right_angle)
      return failure = "the state is singular", false;
    if (!state_.has_tangent) parameter(sample->it.p) = parameter(state_.p);
    segment.add_events(*sample);
    state_.tangent = tangent;
    settle(segment, *sample);
    return true;
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  return false;
}

// Where a function of an event vanishes (a force, say) J may be singular though the branch is regular: its tangent is that of
// a state a little beside, on the way that is asked for.
bool Walker::start_beside_event(bool singular) {
  constexpr double steep = 1e-3, aside = 1e-6;
  const double here = singular ? 0.0 : std::abs(state_.tangent.p);
  if (state_.has_tangent || here > steep * options_.parameter_scale) return false;
  try {
    const std::vector<EventFunction> events = state_.problem->events(state_.x, state_.p);
    if (std::none_of(events.begin(), events.end(), [&](const EventFunction& event) {
          return !event.passes && std::abs(event.value) <= rounded_zero();
        }))
      return false;
    if (!is_solution(*state_.problem, state_.x, state_.p, options_)) return false;
    const Borders fixed = fixed_parameter(*state_.problem, options_);
    Iterate it{state_.x, Vector::Zero(state_.problem->size()), state_.p, Vector::Zero(1)};
    parameter(it.p) += aside * options_.direction * options_.parameter_scale;
    if (!correct(*state_.problem, fixed, it, options_).converged) return false;
    double lean = 0.0;
    const Tangent tangent = first_tangent(*state_.problem, it.x, it.p, options_, options_.direction, &lean);
    if (lean > kSingular || std::abs(tangent.p) < 10.0 * here) return false;  // a fold is as steep there
    const Vector x = state_.x, p = state_.p;
    start_at(x, p, tangent);
    return true;
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return false;
}

// A state with a tangent where J is singular: index and determinant are unknown there.
void Walker::start_at(const Vector& x, const Vector& p, const Tangent& tangent) {
  state_.tangent = state_.has_tangent ? tangent : oriented(tangent, options_.direction);
  Segment segment(state_.problem, options_, x, p, state_.tangent);
  Sample& sample = segment.base();
  segment.add_events(sample);
  settle(segment, sample);
}

void Walker::queue_branch_point(BranchPoint point) {
  Located located;
  located.type = PointType::branch_point;
  located.sample.it.x = point.x;
  located.sample.it.p = point.p;
  located.sample.tangent = state_.tangent;
  located.precision = point.precision;
  located.multiplicity = point.multiplicity;
  located.branch_point = std::move(point);
  Segment segment(state_.problem, options_, state_.x, state_.p, state_.tangent);
  queue_.push_back(special(segment, located));
}

// J is singular. The branch point is where the two first derivatives of the reduced equation vanish; with the null vector
// φ as the border a fold is regular, and p adjusts to it; a kernel of two dimensions is left along α = 0.
bool Walker::start_singular() {
  if (state_.has_tangent) return start_at_given();
  return start_at_branch_point() || start_at_fold() || start_at_double_point();
}

// A singular state that was handed over with its tangent is kept as it is, if it is a solution.
bool Walker::start_at_given() {
  try {
    if (!is_solution(*state_.problem, state_.x, state_.p, options_)) return false;
    start_at(state_.x, state_.p, Tangent(state_.tangent));
    return true;
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return false;
}

bool Walker::start_at_branch_point() {
  std::string why;
  std::optional<BranchPoint> point =
      branch_point_at(*state_.problem, options_, state_.x, state_.p, kNear, why);
  if (!point) return false;
  start_at(point->x, point->p, point->tangents[0]);
  queue_branch_point(std::move(*point));
  return true;
}

bool Walker::start_at_fold() {
  Problem& problem = *state_.problem;
  try {
    const Vector phi = null_vectors(problem, state_.x, state_.p, 1, options_).right.col(0);
    Segment segment(state_.problem, options_, state_.x, state_.p, Tangent{phi, 0.0});
    const Sample* sample = segment.corrected();
    // p is stationary: beside the fold it differs by the square of the distance.
    if (!sample || std::abs(sample->it.y[0]) > kNear * kNear * options_.parameter_scale) return false;
    start_at(sample->it.x, sample->it.p, sample->tangent);
    return true;
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return false;
}

bool Walker::start_at_double_point() {
  Problem& problem = *state_.problem;
  try {
    NullVectors null = null_vectors(problem, state_.x, state_.p, 2, options_);
    Reduced reduced(problem, options_, state_.x, state_.p, null, {options_.parameter});
    const std::optional<Reduced::Value> value = reduced.at(state_.p, Vector::Zero(2));
    if (!value) return false;
    BranchPoint point;
    point.x = value->it.x;
    point.p = value->it.p;
    point.u = value->it.u;
    point.multiplicity = 2;
    point.polished = true;
    point.null = reduced.refreshed(*value);
    Tangent tangent{value->x_parameter.col(0), 1.0};
    normalise(problem, tangent, options_.scales());
    start_at(point.x, point.p, tangent);
    queue_branch_point(std::move(point));
    return true;
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return false;
}

}  // namespace continuation
