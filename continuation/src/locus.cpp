#include "continuation/locus.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace continuation {
namespace {

// Unit direction (in the scaled metric) that the m − 1 rows leave free.
Vector free_direction(const Matrix& jacobian, const Vector& scale) {
  Matrix scaled = jacobian * scale.asDiagonal();
  for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
    const double length = scaled.row(i).norm();
    if (length > 0.0) scaled.row(i) /= length;
  }
  Eigen::JacobiSVD<Matrix> svd(scaled, Eigen::ComputeFullV);
  return scale.asDiagonal() * svd.matrixV().col(scaled.cols() - 1);
}

}  // namespace

void LocusOptions::validate() const {
  options.validate();
  if (second < 0 || second == options.parameter)
    throw std::invalid_argument(
        "locus options: second >= 0 and different from parameter is violated, the value is " +
        std::to_string(second));
  if (!(second_lower < second_upper))
    throw std::invalid_argument("locus options: second_lower < second_upper is violated");
  if (!(second_scale > 0.0)) throw std::invalid_argument("locus options: second_scale > 0 is violated");
}

LocusWalker::LocusWalker(const Point& special, const LocusOptions& options)
    : options_(options), kind_(LocusKind::fold), step_length_(options.options) {
  options_.validate();
  switch (special.type) {
    case PointType::fold:
      kind_ = LocusKind::fold;
      break;
    case PointType::branch_point:
      kind_ = LocusKind::branch_point;
      break;
    case PointType::event:
      kind_ = LocusKind::event;
      break;
    default:
      throw std::invalid_argument(
          "locus: a fold, a branch point or an event is needed, this point is of type " +
          std::string(name(special.type)));
  }
  if (!special.problem) throw std::invalid_argument("locus: no problem");
  if (std::max(options_.second, options_.options.parameter) >= special.p.size())
    throw std::invalid_argument("locus: the problem has only " + std::to_string(special.p.size()) +
                                " parameters");
  problem_ = special.problem->clone();
  x_ = special.x;
  p_ = special.p;
  multiplicity_ = std::max(1, special.multiplicity);
  event_ = special.event;
}

std::optional<LocusPoint> LocusWalker::step() {
  if (queue_.empty() && !end_ && !pending_end_) {
    if (!started_) {
      start();
    } else {
      advance();
    }
  }
  std::optional<LocusPoint> point;
  if (!queue_.empty()) {
    point = std::move(queue_.front());
    queue_.erase(queue_.begin());
  }
  if (queue_.empty() && pending_end_) end_ = std::exchange(pending_end_, {});
  return point;
}

LocusPoint LocusWalker::make(LocusPoint::Type type, const Solution& solution) const {
  LocusPoint point;
  point.problem = problem_;
  point.type = type;
  point.x = system_->value().it.x;
  point.p = system_->value().it.p;
  point.tangent = tangent_;
  point.newton_iterations = solution.iterations;
  point.precision = solution.precision;
  return point;
}

// Makes (x, p), or the special point next to it across `orientation`, the base of a new system, and finds
// the tangent there. With null vectors given, (x, p) is known to be the point.
bool LocusWalker::rebase(std::shared_ptr<Problem> problem, const Vector& x, const Vector& p,
                         std::optional<NullVectors> null, const Vector& orientation, std::string& failure) {
  const bool known = null.has_value();
  const auto make_system = [&](const Vector& at_x, const Vector& at_p, std::optional<NullVectors> vectors) {
    return std::make_unique<LocusSystem>(problem, options_.options, kind_, multiplicity_, event_,
                                         options_.options.parameter, options_.second, at_x, at_p,
                                         std::move(vectors));
  };
  std::unique_ptr<LocusSystem> keep = std::move(system_);
  const Vector keep_scale = scale_;
  const auto fail = [&] {
    system_ = std::move(keep);
    scale_ = keep_scale;
    return false;
  };
  try {
    system_ = make_system(x, p, std::move(null));
    scale_ = Vector::Ones(system_->size());
    scale_[0] = options_.options.parameter_scale;
    scale_[1] = options_.second_scale;
    std::optional<Vector> r = system_->residual(system_->base());
    std::optional<Matrix> jacobian = r ? system_->jacobian(system_->base(), *r) : std::nullopt;
    if (!jacobian) return failure = system_->failure(), fail();
    if (!known) {
      for (int round = 0; round < 2; ++round) {  // the second with the null vectors of the first
        Vector row = Vector::Zero(system_->size());
        row.head(2) = orientation.head(2);
        if (row.norm() == 0.0) row[1] = 1.0;
        const std::optional<Solution> solution =
            solve(row, row.dot(system_->base()), system_->base(), *jacobian, failure);
        if (!solution) return fail();
        const Vector at_x = system_->value().it.x, at_p = system_->value().it.p;
        NullVectors fresh = system_->refreshed();
        system_ = make_system(at_x, at_p, std::move(fresh));
        r = system_->residual(system_->base());
        jacobian = r ? system_->jacobian(system_->base(), *r) : std::nullopt;
        if (!jacobian) return failure = system_->failure(), fail();
      }
    }
    jacobian_ = *jacobian;
    z_ = system_->base();
    const bool same_space = orientation.size() == system_->size() && problem == problem_;
    tangent_ = free_direction(jacobian_, scale_);
    const Eigen::Index compared = same_space ? system_->size() : 2;
    const double cosine = tangent_.head(compared)
                              .cwiseQuotient(scale_.head(compared))
                              .dot(orientation.head(compared).cwiseQuotient(scale_.head(compared)));
    if (cosine < 0.0) tangent_ = -tangent_;
    problem_ = std::move(problem);
    x_ = system_->value().it.x;
    p_ = system_->value().it.p;
    events_ = problem_->events(x_, p_);
    return true;
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::invalid_argument& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  return fail();
}

void LocusWalker::start() {
  started_ = true;
  Vector orientation = Vector::Zero(2);
  orientation[1] = options_.options.direction;  // μ is kept while the start is corrected
  std::string failure;
  if (!rebase(problem_, x_, p_, std::nullopt, orientation, failure)) {
    end_ = End{End::Kind::lost, std::string("the ") + name(kind_) + " is not found at the start: " + failure};
    return;
  }
  points_ = 1;
  start_p_ = p_;
  start_tangent_ = tangent_;
  system_->residual(z_);  // the differences moved away
  LocusPoint point = make(LocusPoint::Type::start, {});
  point.null = system_->refreshed();
  queue_.push_back(std::move(point));
}

void LocusWalker::advance() {
  if (points_ >= options_.options.max_points) {
    end_ = End{End::Kind::max_points,
               "max_points = " + std::to_string(options_.options.max_points) + " reached"};
    return;
  }
  const std::pair<double, double> bounds[] = {{options_.options.lower, options_.options.upper},
                                              {options_.second_lower, options_.second_upper}};
  for (int i = 0; i < 2; ++i) {
    const double at = z_[i];
    if ((at <= bounds[i].first && tangent_[i] < 0.0) || (at >= bounds[i].second && tangent_[i] > 0.0)) {
      end_ = End{End::Kind::bound, "a parameter leaves its bounds"};
      return;
    }
  }
  adapt();
  if (end_) return;
  for (;;) {
    std::string failure;
    if (advance_once(failure)) return;
    if (!step_length_.rejected()) {
      std::ostringstream message;
      message << "Newton failed at step_min (step " << step_length_.current() << ", parameters "
              << p_[options_.options.parameter] << ", " << p_[options_.second] << "): " << failure;
      end_ = End{End::Kind::lost, message.str()};
      return;
    }
  }
}

// Goes on from the solution in the same system; a new base only where its borders are no longer close to
// null vectors.
bool LocusWalker::settle(const Solution& solution, const Matrix& jacobian, LocusPoint& point,
                         std::string& failure) {
  const Vector orientation = tangent_;
  if (system_->alignment() < 0.9) {
    if (!rebase(problem_, point.x, point.p, point.null, orientation, failure)) return false;
  } else {
    z_ = solution.z;
    jacobian_ = jacobian;
    tangent_ = free_direction(jacobian_, scale_);
    if (tangent_.cwiseQuotient(scale_).dot(orientation.cwiseQuotient(scale_)) < 0.0) tangent_ = -tangent_;
    x_ = point.x;
    p_ = point.p;
    events_ = problem_->events(x_, p_);
  }
  point.tangent = tangent_;
  return true;
}

void LocusWalker::adapt() {
  if (!std::exchange(adapt_pending_, false) || !options_.options.adapt) return;
  // The new tangent is oriented in the plane of the parameters, where a cusp has no direction.
  if (tangent_.head(2).cwiseQuotient(scale_.head(2)).norm() < 0.2) return;
  std::string failure;
  try {
    const std::optional<Vector> adapted = problem_->adapt(x_, p_);
    if (!adapted) return;
    const Vector orientation = tangent_.head(2);
    if (rebase(problem_, *adapted, p_, std::nullopt, orientation, failure)) return;
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  end_ = End{End::Kind::lost, "after adapting the discretisation: " + failure};
}

void LocusWalker::pass(LocusPoint point, std::size_t which, const std::string& event) {
  point.problem = problem_->clone();
  point.event = event;
  std::string failure;
  std::optional<Transition> transition;
  try {
    transition = problem_->transition(which, x_, p_);
  } catch (const std::domain_error& error) {
    failure = std::string(": ") + error.what();
  } catch (const std::runtime_error& error) {
    failure = std::string(": ") + error.what();
  }
  if (transition) {
    point.before = transition->before;
    point.after = transition->after;
  }
  const auto finish = [&](const std::string& reason) {
    queue_.push_back(std::move(point));
    pending_end_ = End{End::Kind::event, "event " + event + ": " + reason};
  };
  if (!transition) return finish("no continuation is known" + failure);
  if (!transition->problem) return finish("the solution ends");
  if (!options_.pass_events) return finish("reached");
  if (++transitions_in_place_ > 5) return finish("events repeat without progress");
  const Vector orientation = tangent_.head(2);
  if (!rebase(transition->problem, transition->state, p_, std::nullopt, orientation, failure))
    return finish(std::string("the ") + name(kind_) + " is not found beyond it (" + failure + ")");
  // Valid beyond: no event negative a little further on.
  const Vector base = z_, row = tangent_.cwiseQuotient(scale_.cwiseAbs2());
  for (const int sign : {1, -1}) {
    for (const double part : {0.1, 0.01, 1e-3}) {
      const double s = sign * part * step_length_.current();
      if (!solve(row, row.dot(base) + s, base + s * tangent_, jacobian_, failure)) continue;
      const auto values = problem_->events(system_->value().it.x, system_->value().it.p);
      const bool valid = std::all_of(values.begin(), values.end(), [&](const EventFunction& e) {
        return e.name == event_ || e.value >= -options_.options.event_zero;
      });
      if (!valid) continue;
      tangent_ *= sign;
      system_->residual(base);
      step_length_.reset(0.1 * step_length_.usual());
      queue_.push_back(std::move(point));
      return;
    }
  }
  finish("the special point is not valid beyond it");
}

}  // namespace continuation
