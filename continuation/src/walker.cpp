#include "continuation/walker.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace continuation {
const char* name(PointType type) {
  switch (type) {
    case PointType::start:
      return "start";
    case PointType::regular:
      return "regular";
    case PointType::fold:
      return "fold";
    case PointType::branch_point:
      return "branch_point";
    case PointType::event:
      return "event";
    case PointType::end:
      return "end";
    case PointType::hopf:
      return "hopf";
    case PointType::function:
      return "function";
  }
  return "?";
}

namespace {

WalkState at_start(std::shared_ptr<Problem> problem, Vector x, Vector p) {
  WalkState state;
  state.problem = std::move(problem);
  state.x = std::move(x);
  state.p = std::move(p);
  return state;
}

}  // namespace

Walker::Walker(WalkState state, const Options& options)
    : state_(std::move(state)), options_(options), step_length_(options) {
  options_.validate();
  if (!state_.problem) throw std::invalid_argument("continuation: no problem");
  if (options_.parameter >= state_.p.size()) {
    throw std::invalid_argument("continuation: parameter " + std::to_string(options_.parameter) + " of " +
                                std::to_string(state_.p.size()) + " parameters does not exist");
  }
  if (state_.started)
    step_length_ = StepLength(options, state_.step, state_.usual_step, state_.after_rejection);
}

Walker::Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, const Options& options)
    : Walker(at_start(std::move(problem), std::move(x), std::move(p)), options) {}

Walker::Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, Tangent tangent, const Options& options)
    : Walker(std::move(problem), std::move(x), std::move(p), options) {
  if (tangent.x.size() != state_.problem->size()) {
    throw std::invalid_argument("continuation: the tangent has " + std::to_string(tangent.x.size()) +
                                " entries, the problem " + std::to_string(state_.problem->size()));
  }
  normalise(*state_.problem, tangent, options_.scales());
  state_.tangent = std::move(tangent);
  state_.has_tangent = true;
}

WalkState Walker::state() const {
  assert(at_rest());
  WalkState state = state_;
  state.step = step_length_.current();
  state.usual_step = step_length_.usual();
  state.after_rejection = step_length_.after_rejection();
  return state;
}

void Walker::stop(const std::string& reason) {
  queue_.clear();
  pending_end_ = {};
  state_.end = End{End::Kind::stopped, reason};
}

std::optional<Point> Walker::step() {
  while (queue_.empty() && !state_.end && !pending_end_) {
    if (!state_.started) {
      start();
    } else {
      advance();
    }
  }
  if (queue_.empty()) {
    if (pending_end_) state_.end = std::exchange(pending_end_, {});
    return std::nullopt;
  }
  Point point = std::move(queue_.front());
  queue_.pop_front();
  if (queue_.empty() && pending_end_) state_.end = std::exchange(pending_end_, {});
  return point;
}

Point Walker::here(PointType type) const {
  Point point;
  point.problem = state_.problem;
  point.x = state_.x;
  point.p = state_.p;
  point.tangent = state_.tangent;
  point.type = type;
  point.index = point.index_after = state_.index;
  point.path_length = state_.path_length;
  point.functions = function_values(point.x, point.p);
  return point;
}

std::vector<double> Walker::function_values(const Vector& x, const Vector& p) const {
  std::vector<double> values;
  for (const UserFunction& function : options_.functions) values.push_back(function.value(x, p));
  return values;
}

void Walker::remember_start() {
  state_.start_x = state_.x;
  state_.mesh_changed = false;
  state_.start_fingerprint = state_.problem->fingerprint(state_.x, state_.p);
  state_.start_parameter = parameter(state_.p);
  state_.start_slope = state_.tangent.p;
}

// Makes a completed sample with events the walker's state.
void Walker::settle(Segment& segment, Sample& sample) {
  state_.problem = segment.problem();
  state_.x = sample.it.x;
  state_.p = sample.it.p;
  state_.previous_tangent = state_.tangent;
  state_.tangent = sample.tangent;
  state_.index = sample.index;
  state_.complex_index = sample.complex_index;
  state_.breaking_index = sample.breaking_index;
  state_.determinant = sample.determinant;
  state_.small = sample.small;
  state_.previous_events = std::exchange(state_.events, sample.events);
  state_.path_length += sample.s;
  state_.last_ds = sample.s;
  for (const EventFunction& event : state_.events) {
    if (std::abs(event.value) > options_.event_zero) state_.signs[event.name] = event.value > 0.0 ? 1 : -1;
  }
}

void Walker::advance() {
  if (state_.points >= options_.max_points) {
    state_.end =
        End{End::Kind::max_points, "max_points = " + std::to_string(options_.max_points) + " reached"};
    return;
  }
  for (const double bound : {options_.lower, options_.upper}) {
    if (parameter(state_.p) == bound && state_.tangent.p * (bound == options_.upper ? 1.0 : -1.0) > 0.0) {
      state_.end = End{End::Kind::bound, "the parameter leaves its bounds"};
      return;
    }
  }
  for (;;) {
    std::string failure;
    if (advance_once(failure)) return;
    if (!step_length_.rejected()) {
      if (event_at_edge()) return;
      std::ostringstream message;
      message << "Newton failed at step_min (step " << step_length_.current() << ", parameter "
              << parameter(state_.p) << "): " << failure;
      return lose(message.str());
    }
  }
}

}  // namespace continuation
