#include "continuation/walker.hpp"

#include <algorithm>
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
  }
  return "?";
}

Walker::Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, const Options& options)
    : problem_(std::move(problem)),
      x_(std::move(x)),
      p_(std::move(p)),
      options_(options),
      step_length_(options) {
  options_.validate();
  if (!problem_) throw std::invalid_argument("continuation: no problem");
  if (options_.parameter >= p_.size()) {
    throw std::invalid_argument("continuation: parameter " + std::to_string(options_.parameter) + " of " +
                                std::to_string(p_.size()) + " parameters does not exist");
  }
}

Walker::Walker(std::shared_ptr<Problem> problem, Vector x, Vector p, Tangent tangent, const Options& options)
    : Walker(std::move(problem), std::move(x), std::move(p), options) {
  if (tangent.x.size() != problem_->size()) {
    throw std::invalid_argument("continuation: the tangent has " + std::to_string(tangent.x.size()) +
                                " entries, the problem " + std::to_string(problem_->size()));
  }
  normalise(*problem_, tangent, options_.parameter_scale);
  tangent_ = std::move(tangent);
  has_tangent_ = true;
}

void Walker::stop(const std::string& reason) {
  queue_.clear();
  pending_end_ = {};
  end_ = End{End::Kind::stopped, reason};
}

std::optional<Point> Walker::step() {
  if (queue_.empty() && !end_ && !pending_end_) {
    if (!started_) {
      start();
    } else {
      advance();
    }
  }
  if (queue_.empty()) {
    if (pending_end_) end_ = std::exchange(pending_end_, {});
    return std::nullopt;
  }
  Point point = std::move(queue_.front());
  queue_.pop_front();
  if (queue_.empty() && pending_end_) end_ = std::exchange(pending_end_, {});
  return point;
}

void Walker::start() {
  started_ = true;
  try {
    if (!has_tangent_) {
      Borders fixed;
      fixed.parameter = options_.parameter;
      fixed.scale = options_.parameter_scale;
      fixed.psi = Matrix(problem_->size(), 0);
      fixed.c = Matrix::Zero(problem_->size(), 1);
      fixed.d = Matrix::Ones(1, 1);
      fixed.g = Vector::Zero(1);
      Iterate it{x_, Vector::Zero(problem_->size()), p_, Vector::Zero(1)};
      Options patient = options_;  // a cold start deserves more corrections than a step
      patient.max_newton = std::max(options_.max_newton, 20);
      const CorrectorReport report = correct(*problem_, fixed, it, patient);
      if (!report.converged) return lose("no solution at the start: " + report.failure);
      x_ = it.x;
      tangent_ = first_tangent(*problem_, x_, p_, options_, options_.direction);
    }
    Segment segment(problem_, options_, x_, p_, tangent_);
    segment.base().complete = false;
    Sample* sample = segment.at(0.0, true);
    if (!sample) return lose("no solution at the start: " + segment.failure());
    if (!has_tangent_) parameter(sample->it.p) = parameter(p_);
    segment.add_events(*sample);
    settle(segment, *sample);
  } catch (const std::domain_error& error) {
    return lose(std::string("no solution at the start: ") + error.what());
  } catch (const std::runtime_error& error) {
    return lose(std::string("no solution at the start: ") + error.what());
  }
  points_ = 1;
  previous_tangent_ = tangent_;
  remember_start();
  Point point;
  point.problem = problem_;
  point.x = x_;
  point.p = p_;
  point.tangent = tangent_;
  point.type = PointType::start;
  point.index = point.index_after = index_;
  queue_.push_back(std::move(point));
}

void Walker::remember_start() {
  start_x_ = x_;
  mesh_changed_ = false;
  start_fingerprint_ = problem_->fingerprint(x_, p_);
  start_parameter_ = parameter(p_);
  start_slope_ = tangent_.p;
}

// Makes a completed sample with events the walker's state.
void Walker::settle(Segment& segment, Sample& sample) {
  problem_ = segment.problem();
  x_ = sample.it.x;
  p_ = sample.it.p;
  previous_tangent_ = tangent_;
  tangent_ = sample.tangent;
  index_ = sample.index;
  determinant_ = sample.determinant;
  previous_events_ = std::exchange(events_, sample.events);
  path_length_ += sample.s;
  last_ds_ = sample.s;
  for (const EventFunction& event : events_) {
    if (std::abs(event.value) > options_.event_zero) signs_[event.name] = event.value > 0.0 ? 1 : -1;
  }
}

void Walker::advance() {
  if (points_ >= options_.max_points) {
    end_ = End{End::Kind::max_points, "max_points = " + std::to_string(options_.max_points) + " reached"};
    return;
  }
  for (const double bound : {options_.lower, options_.upper}) {
    if (parameter(p_) == bound && tangent_.p * (bound == options_.upper ? 1.0 : -1.0) > 0.0) {
      end_ = End{End::Kind::bound, "the parameter leaves its bounds"};
      return;
    }
  }
  adapt();
  if (end_) return;
  for (;;) {
    std::string failure;
    if (advance_once(failure)) return;
    if (!step_length_.rejected()) {
      if (event_at_edge()) return;
      std::ostringstream message;
      message << "Newton failed at step_min (step " << step_length_.current() << ", parameter "
              << parameter(p_) << "): " << failure;
      return lose(message.str());
    }
  }
}

}  // namespace continuation
