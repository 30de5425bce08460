// One step of a locus: corrector, bounds, other events, degenerate points.

#include <algorithm>
#include <cmath>
#include <utility>

#include "continuation/bracket.hpp"
#include "continuation/locus.hpp"

namespace continuation {
namespace {

const EventFunction* find(const std::vector<EventFunction>& events, const std::string& name) {
  const auto it =
      std::find_if(events.begin(), events.end(), [&](const auto& event) { return event.name == name; });
  return it == events.end() ? nullptr : &*it;
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

bool LocusWalker::advance_once(std::string& failure) {
  const Vector base = z_;
  const double ds = step_length_.current();
  const Vector row = tangent_.cwiseQuotient(scale_.cwiseAbs2());
  const auto at = [&](double s, const Vector& guess, std::string& why) {
    return solve(row, row.dot(base) + s, guess, jacobian_, why);
  };
  std::optional<Solution> end = at(ds, base + ds * tangent_, failure);
  if (!end) return false;
  if ((end->z - base - ds * tangent_).cwiseQuotient(scale_).norm() > 0.6 * ds)
    return failure = "the locus turns too much", false;
  const Solution whole = *end;
  const auto between = [&](double s) { return Vector(base + (s / ds) * (whole.z - base)); };
  double s_end = ds;
  End reason;

  const std::pair<double, double> bounds[] = {{options_.options.lower, options_.options.upper},
                                              {options_.second_lower, options_.second_upper}};
  for (int i = 0; i < 2; ++i) {
    for (const double bound : {bounds[i].first, bounds[i].second}) {
      const double a = base[i] - bound, b = end->z[i] - bound;
      if (!std::isfinite(bound) || a == 0.0 || (b != 0.0 && (a < 0.0) == (b < 0.0))) continue;
      const Vector guess = base + (end->z - base) * (a / (a - b));
      std::optional<Solution> exact = solve(Vector::Unit(base.size(), i), bound, guess, jacobian_, failure);
      if (!exact) return false;
      exact->z[i] = bound;
      end = exact;
      s_end = row.dot(end->z - base);
      reason = End{End::Kind::bound, std::string(i == 0 ? "first" : "second") + " parameter reached its " +
                                         (bound == bounds[i].first ? "lower" : "upper") + " bound"};
    }
  }

  // The first other event on the way.
  std::string crossed;
  for (int round = 0; round < 5; ++round) {
    if (!system_->residual(end->z)) return failure = system_->failure(), false;
    const std::vector<EventFunction> now = problem_->events(system_->value().it.x, system_->value().it.p);
    const EventFunction* first = nullptr;
    for (const EventFunction& event : events_) {
      // Zero together with the one followed (mirror images): no event of its own.
      if (event.name == event_ || event.name == crossed || event.passes || event.value <= 1e-7) continue;
      const EventFunction* after = find(now, event.name);
      if (after && after->value < -options_.options.event_zero && (!first || after->value < first->value))
        first = &event;
    }
    if (!first) break;
    std::string why;
    const Bracket bracket =
        find_zero(0.0, first->value, s_end, find(now, first->name)->value,
                  options_.options.location_tolerance, [&](double s) -> std::optional<double> {
                    if (!at(s, between(s), why)) return std::nullopt;
                    const auto values = problem_->events(system_->value().it.x, system_->value().it.p);
                    const EventFunction* value = find(values, first->name);
                    return value ? std::optional(value->value) : std::nullopt;
                  });
    if (!bracket.converged) return failure = "event " + first->name + ": " + why, false;
    end = at(bracket.best, between(bracket.best), failure);
    if (!end) return false;
    s_end = bracket.best;
    crossed = first->name;
    reason = {};
  }

  // Back at the start in the plane of the parameters, in the same direction.
  if (!reason && crossed.empty() && points_ > 3 && start_tangent_.size() == tangent_.size()) {
    const Eigen::Vector2d from = base.head(2).cwiseQuotient(scale_.head(2)),
                          to = end->z.head(2).cwiseQuotient(scale_.head(2));
    Eigen::Vector2d start(start_p_[options_.options.parameter], start_p_[options_.second]);
    start = start.cwiseQuotient(Eigen::Vector2d(scale_.head(2)));
    const Eigen::Vector2d chord = to - from, way = start_tangent_.head(2).cwiseQuotient(scale_.head(2));
    const double part = chord.squaredNorm() > 0.0 ? (start - from).dot(chord) / chord.squaredNorm() : -1.0;
    if (part > 0.0 && part <= 1.0 && (from + part * chord - start).norm() < 0.1 * chord.norm() &&
        way.dot(chord) > 0.8 * way.norm() * chord.norm())
      reason = End{End::Kind::closed, "closed: the locus is back at its start"};
  }

  // The solution's own values (other solves may have come in between), then a degenerate point passed on the
  // way.
  const std::optional<Vector> r = system_->residual(end->z);
  if (!r) return failure = system_->failure(), false;
  LocusPoint point =
      make(crossed.empty() && reason ? LocusPoint::Type::end : LocusPoint::Type::regular, *end);
  point.null = system_->refreshed();
  point.ds = s_end;
  const std::optional<Matrix> at_end = system_->jacobian(end->z, *r);
  if (!at_end) return failure = system_->failure(), false;
  const double before = degeneracy(jacobian_), after = degeneracy(*at_end);
  if (before * after < 0.0 && s_end > 0.0) {
    std::string why;
    Solution found;
    const auto value = [&](double s) -> std::optional<double> {
      const std::optional<Solution> there = at(s, between(s), why);
      if (!there) return std::nullopt;
      found = *there;
      const std::optional<Vector> residual = system_->residual(there->z);
      const std::optional<Matrix> jacobian = residual ? system_->jacobian(there->z, *residual) : std::nullopt;
      return jacobian ? std::optional(degeneracy(*jacobian)) : std::nullopt;
    };
    const Bracket bracket = find_zero(0.0, before, s_end, after, 1e-7 * ds, value);  // differences: no better
    if (value(bracket.best)) {
      system_->residual(found.z);
      LocusPoint special = make(LocusPoint::Type::degenerate, found);
      special.problem = problem_->clone();
      special.null = system_->refreshed();
      special.note = kind_ == LocusKind::fold           ? "cusp"
                     : kind_ == LocusKind::branch_point ? "the two branches are tangent"
                                                        : "the event function is tangent to the branch";
      special.precision = bracket.hi - bracket.lo;
      special.ds = bracket.best;
      queue_.push_back(std::move(special));
    }
    if (!system_->residual(end->z)) return queue_.clear(), failure = system_->failure(), false;
  }
  const double imperfection = system_->imperfection(*at_end);
  if (!settle(*end, *at_end, point, failure)) return queue_.clear(), false;
  ++points_;
  if (crossed.empty() && !reason && imperfection > 1e-4) {
    reason = End{End::Kind::event, "the branch point comes apart: its two branches no longer meet"};
    point.type = LocusPoint::Type::end;
  }
  if (!crossed.empty()) {
    point.type = LocusPoint::Type::event;
    const auto which =
        std::find_if(events_.begin(), events_.end(), [&](const auto& e) { return e.name == crossed; });
    pass(std::move(point), static_cast<std::size_t>(which - events_.begin()), crossed);
    return true;
  }
  queue_.push_back(std::move(point));
  if (reason) {
    pending_end_ = reason;
  } else {
    step_length_.accepted(whole.iterations, whole.contraction);
    adapt_pending_ = true;
    transitions_in_place_ = 0;
  }
  return true;
}

}  // namespace continuation
