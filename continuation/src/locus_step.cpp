// One step of a locus: corrector, bounds, other events, degenerate points.

#include <algorithm>
#include <cmath>
#include <utility>

#include "continuation/bracket.hpp"
#include "continuation/locus.hpp"
#include "event_by_name.hpp"

namespace continuation {
namespace {

std::string degeneracy_note(LocusKind kind) {
  if (kind == LocusKind::fold) return "cusp";
  if (kind == LocusKind::branch_point) return "the two branches are tangent";
  return "the event function is tangent to the branch";
}

}  // namespace

// Newton's method on the locus equations and row·z = value, with the Jacobian kept while it contracts.
std::optional<LocusWalker::Solution> LocusWalker::solve(const Vector& row, double value, Vector z,
                                                        Matrix jacobian, std::string& failure) {
  const Eigen::Index m = system_->size();
  const Options& options = options_.options;
  Solution solution;
  double previous = 0.0;
  for (int k = 0; k <= options.max_newton; ++k) {
    std::optional<Vector> r = system_->residual(z);
    if (!r) return failure = system_->failure(), std::nullopt;
    Matrix matrix(m, m);
    Vector rhs(m);
    const auto correction = [&] {
      matrix << jacobian, row.transpose();
      rhs << -*r, value - row.dot(z);
      return Vector(matrix.fullPivLu().solve(rhs));
    };
    Vector dz = correction();
    double size = dz.cwiseQuotient(scale_).norm();
    if (k > 0 && size > 0.2 * previous && size > options.location_tolerance) {
      const std::optional<Matrix> fresh = system_->jacobian(z, *r);
      if (!fresh) return failure = system_->failure(), std::nullopt;
      jacobian = *fresh;
      dz = correction();
      size = dz.cwiseQuotient(scale_).norm();
    }
    if (!std::isfinite(size)) return failure = "the locus equations are singular", std::nullopt;
    if (k > 0 && size > 2.0 * previous && size > 1e-6)
      return failure = "Newton's corrections grow", std::nullopt;
    if (k == 1) solution.contraction = size / previous;
    z += dz;
    const double in_parameters = dz.head(2).cwiseAbs().maxCoeff();
    const double tolerance = options.location_tolerance * std::max(1.0, z.head(2).cwiseAbs().maxCoeff());
    if (in_parameters <= tolerance && size <= 1e-7) {
      if (!system_->residual(z)) return failure = system_->failure(), std::nullopt;
      solution.z = z;
      solution.precision = in_parameters;
      return solution;
    }
    previous = size;
    ++solution.iterations;
  }
  return failure = "no convergence in " + std::to_string(options.max_newton) + " corrections", std::nullopt;
}

double LocusWalker::degeneracy(const Matrix& j) const {
  if (j.cols() != 3) return 1.0;
  // Fold: y_αα. Branch point, event: the derivative with respect to (λ, α), singular where the locus turns
  // in μ.
  return kind_ == LocusKind::fold ? j(1, 2) : j(0, 0) * j(1, 2) - j(0, 2) * j(1, 0);
}

std::optional<LocusWalker::Solution> LocusWalker::solve_at(const Step& step, double s, const Vector& guess,
                                                           std::string& failure) {
  return solve(step.row, step.row.dot(step.base) + s, guess, jacobian_, failure);
}

std::optional<LocusWalker::Step> LocusWalker::predict_and_correct(std::string& failure) {
  Step step;
  step.base = z_;
  step.row = tangent_.cwiseQuotient(scale_.cwiseAbs2());
  step.ds = step.s_end = step_length_.current();
  const std::optional<Solution> corrected = solve_at(step, step.ds, step.base + step.ds * tangent_, failure);
  if (!corrected) return std::nullopt;
  if ((corrected->z - step.base - step.ds * tangent_).cwiseQuotient(scale_).norm() > 0.6 * step.ds)
    return failure = "the locus turns too much", std::nullopt;
  step.whole = step.end = *corrected;
  return step;
}

bool LocusWalker::shorten_to_bounds(Step& step, std::string& failure) {
  const Vector& base = step.base;
  const std::pair<double, double> bounds[] = {{options_.options.lower, options_.options.upper},
                                              {options_.second_lower, options_.second_upper}};
  for (int i = 0; i < 2; ++i) {
    for (const double bound : {bounds[i].first, bounds[i].second}) {
      const double a = base[i] - bound, b = step.end.z[i] - bound;
      if (!std::isfinite(bound) || a == 0.0 || (b != 0.0 && (a < 0.0) == (b < 0.0))) continue;
      const Vector guess = base + (step.end.z - base) * (a / (a - b));
      std::optional<Solution> exact = solve(Vector::Unit(base.size(), i), bound, guess, jacobian_, failure);
      if (!exact) return false;
      exact->z[i] = bound;
      step.end = *exact;
      step.s_end = step.row.dot(step.end.z - base);
      step.reason =
          End{End::Kind::bound, std::string(i == 0 ? "first" : "second") + " parameter reached its " +
                                    (bound == bounds[i].first ? "lower" : "upper") + " bound"};
    }
  }
  return true;
}

const EventFunction* LocusWalker::most_negative_event(const Step& step,
                                                      const std::vector<EventFunction>& at_end) const {
  const EventFunction* first = nullptr;
  for (const EventFunction& event : events_) {
    // Zero together with the one followed (mirror images): no event of its own.
    if (event.name == event_ || event.name == step.crossed || event.passes || event.value <= 1e-7) continue;
    const EventFunction* after = find(at_end, event.name);
    if (after && after->value < -options_.options.event_zero && (!first || after->value < first->value))
      first = &event;
  }
  return first;
}

bool LocusWalker::shorten_to_first_event(Step& step, std::string& failure) {
  for (int round = 0; round < 5; ++round) {
    if (!system_->residual(step.end.z)) return failure = system_->failure(), false;
    const std::vector<EventFunction> at_end = problem_->events(system_->value().it.x, system_->value().it.p);
    const EventFunction* first = most_negative_event(step, at_end);
    if (!first) break;
    std::string why;
    const auto value_at = [&](double s) -> std::optional<double> {
      if (!solve_at(step, s, step.guess(s), why)) return std::nullopt;
      const auto values = problem_->events(system_->value().it.x, system_->value().it.p);
      const EventFunction* value = find(values, first->name);
      return value ? std::optional(value->value) : std::nullopt;
    };
    const Bracket bracket = find_zero(0.0, first->value, step.s_end, find(at_end, first->name)->value,
                                      options_.options.location_tolerance, value_at);
    if (!bracket.converged) return failure = "event " + first->name + ": " + why, false;
    const std::optional<Solution> located = solve_at(step, bracket.best, step.guess(bracket.best), failure);
    if (!located) return false;
    step.end = *located;
    step.s_end = bracket.best;
    step.crossed = first->name;
    step.reason = {};
  }
  return true;
}

// In the plane of the parameters, in the same direction.
bool LocusWalker::is_back_at_start(const Step& step) const {
  if (points_ <= 3 || start_tangent_.size() != tangent_.size()) return false;
  const Eigen::Vector2d from = step.base.head(2).cwiseQuotient(scale_.head(2)),
                        to = step.end.z.head(2).cwiseQuotient(scale_.head(2));
  Eigen::Vector2d start(start_p_[options_.options.parameter], start_p_[options_.second]);
  start = start.cwiseQuotient(Eigen::Vector2d(scale_.head(2)));
  const Eigen::Vector2d chord = to - from, way = start_tangent_.head(2).cwiseQuotient(scale_.head(2));
  const double part = chord.squaredNorm() > 0.0 ? (start - from).dot(chord) / chord.squaredNorm() : -1.0;
  return part > 0.0 && part <= 1.0 && (from + part * chord - start).norm() < 0.1 * chord.norm() &&
         way.dot(chord) > 0.8 * way.norm() * chord.norm();
}

bool LocusWalker::queue_degenerate_point(const Step& step, const Matrix& jacobian_at_end,
                                         std::string& failure) {
  const double before = degeneracy(jacobian_), after = degeneracy(jacobian_at_end);
  if (!(before * after < 0.0 && step.s_end > 0.0)) return true;
  std::string why;
  Solution found;
  const auto value_at = [&](double s) -> std::optional<double> {
    const std::optional<Solution> there = solve_at(step, s, step.guess(s), why);
    if (!there) return std::nullopt;
    found = *there;
    const std::optional<Vector> residual = system_->residual(there->z);
    const std::optional<Matrix> jacobian = residual ? system_->jacobian(there->z, *residual) : std::nullopt;
    return jacobian ? std::optional(degeneracy(*jacobian)) : std::nullopt;
  };
  const double tolerance = 1e-7 * step.ds;  // differences: no better
  const Bracket bracket = find_zero(0.0, before, step.s_end, after, tolerance, value_at);
  if (value_at(bracket.best)) {
    system_->residual(found.z);
    LocusPoint special = make(LocusPoint::Type::degenerate, found);
    special.problem = problem_->clone();
    special.null = system_->refreshed();
    special.note = degeneracy_note(kind_);
    special.precision = bracket.hi - bracket.lo + bracket.noise;
    special.ds = bracket.best;
    queue_.push_back(std::move(special));
  }
  if (!system_->residual(step.end.z)) return queue_.clear(), failure = system_->failure(), false;
  return true;
}

bool LocusWalker::advance_once(std::string& failure) {
  std::optional<Step> step = predict_and_correct(failure);
  if (!step || !shorten_to_bounds(*step, failure) || !shorten_to_first_event(*step, failure)) return false;
  if (!step->reason && step->crossed.empty() && is_back_at_start(*step))
    step->reason = End{End::Kind::closed, "closed: the locus is back at its start"};

  // The solution's own values: other solves may have come in between.
  const std::optional<Vector> residual = system_->residual(step->end.z);
  if (!residual) return failure = system_->failure(), false;
  const bool ends = step->crossed.empty() && step->reason;
  LocusPoint point = make(ends ? LocusPoint::Type::end : LocusPoint::Type::regular, step->end);
  point.null = system_->refreshed();
  point.ds = step->s_end;
  const std::optional<Matrix> jacobian = system_->jacobian(step->end.z, *residual);
  if (!jacobian) return failure = system_->failure(), false;

  if (!queue_degenerate_point(*step, *jacobian, failure)) return false;
  const double imperfection = system_->imperfection(*jacobian);  // settling may replace the system
  if (!settle(step->end, *jacobian, point, failure)) return queue_.clear(), false;
  ++points_;
  if (step->crossed.empty() && !step->reason && imperfection > 1e-4) {
    step->reason = End{End::Kind::event, "the branch point comes apart: its two branches no longer meet"};
    point.type = LocusPoint::Type::end;
  }
  finish_step(*step, std::move(point));
  return true;
}

void LocusWalker::finish_step(const Step& step, LocusPoint point) {
  if (!step.crossed.empty()) {
    point.type = LocusPoint::Type::event;
    const std::ptrdiff_t which = find(events_, step.crossed) - events_.data();
    return pass(std::move(point), static_cast<std::size_t>(which), step.crossed);
  }
  queue_.push_back(std::move(point));
  if (step.reason) {
    pending_end_ = step.reason;
    return;
  }
  step_length_.accepted(step.whole.iterations, step.whole.contraction);
  adapt_pending_ = true;
  transitions_in_place_ = 0;
}

}  // namespace continuation
