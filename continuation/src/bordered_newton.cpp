#include "continuation/bordered_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace continuation {

BorderedSystem::BorderedSystem(Problem& problem, const Borders& borders, Iterate& iterate)
    : problem_(problem), borders_(borders), it_(iterate), n_(problem.size()), defect_(size()) {}

const Vector& BorderedSystem::defect() {
  Vector f = problem_.residual(it_.x, it_.p);
  const Eigen::Index m = borders_.psi.cols();
  if (m > 0) f += borders_.psi * it_.y.tail(m);
  residual_ = problem_.residual_norm(f);
  if (!std::isfinite(residual_)) throw std::runtime_error("the residual is not finite");
  defect_.head(n_) = -f;
  defect_.tail(size() - n_) = borders_.g - borders_.c.transpose() * it_.u - borders_.d * it_.y;
  return defect_;
}

double BorderedSystem::noise() {
  Vector beside = it_.x;
  for (Eigen::Index i = 0; i < beside.size(); ++i)
    beside[i] *= 1.0 + (i % 2 == 0 ? 1.0 : -1.0) * std::numeric_limits<double>::epsilon();
  const Vector f = problem_.residual(beside, it_.p);
  return problem_.residual_norm(f - problem_.residual(it_.x, it_.p));  // last at the iterate, as before
}

void BorderedSystem::factor() {
  Matrix columns(n_, borders_.c.cols());
  if (parameter_free()) columns.col(0) = problem_.parameter_derivative(it_.x, it_.p, borders_.parameter);
  if (borders_.psi.cols() > 0) columns.rightCols(borders_.psi.cols()) = borders_.psi;
  problem_.factor(it_.x, it_.p, columns, borders_.c, borders_.d);
  ++factorizations_;
}

Vector BorderedSystem::solve(const Vector& r) {
  Vector delta = problem_.solve(r.head(n_), r.tail(size() - n_));
  if (!delta.allFinite()) throw std::runtime_error("Newton's correction is not finite");
  return delta;
}

double BorderedSystem::length(const Vector& delta) const {
  const Vector dx = delta.head(n_);
  double square = problem_.inner(dx, dx) / (borders_.state_scale * borders_.state_scale);
  if (parameter_free()) square += std::pow(delta[n_] / borders_.scale, 2);
  return std::sqrt(square);
}

double BorderedSystem::state_size() const {
  const auto n = static_cast<double>(it_.x.size());
  return n == 0.0 ? 0.0 : it_.x.norm() / (std::sqrt(n) * borders_.state_scale);
}

void BorderedSystem::add(const Vector& delta) {
  const Vector dx = delta.head(n_);
  it_.x = problem_.retract(it_.x, dx);
  it_.u += dx;
  it_.y += delta.tail(size() - n_);
  if (parameter_free()) it_.p[borders_.parameter] += delta[n_];
}

namespace {

/// A correction no shorter than this part of the last one: rounding, or a factorisation too old for what is left.
constexpr double no_longer_shrinks = 0.2;
/// Of what is allowed: F that is no rounding.
constexpr double little = 0.03;

}  // namespace

bool StoppingRule::slow(double length) const {
  const double tolerance = options_.newton_tolerance, theta = contraction(length);
  const double allowed = options_.residual_tolerance * options_.residual_scale;
  if (length <= tolerance)
    return settling_ && theta > no_longer_shrinks && previous_residual_ > little * allowed;
  return length * std::pow(theta, 3) > tolerance ||
         (taken_ > 1 && theta > 0.1 && length * theta > tolerance);  // they hardly converge
}

bool StoppingRule::last(double length, double residual, double state_size, bool fresh) {
  const double tolerance = options_.newton_tolerance;
  const double allowed = options_.residual_tolerance * options_.residual_scale;
  // What rounding may leave where the state has large entries; taken only once corrections no longer shrink.
  const double rounding = tolerance * std::max(1.0, state_size);
  // Where F is all rounding, corrections are what nearly singular equations make of it, and no other state is better.
  constexpr double rounded_residual = 1e-3, visible = 1e-6;
  constexpr double still_falls = 0.3;
  const bool falls = taken_ > 0 && residual <= still_falls * previous_residual_;
  // Some sums round to more.
  const auto all_noise = [&] {
    return taken_ > 0 && length <= visible && residual <= allowed && is_noise(residual);
  };
  const bool exhausted =
      fresh && length <= visible && (residual <= rounded_residual * allowed || (!falls && all_noise()));
  bool stagnant = false;
  // A far guess may be improved by corrections of any size at first.
  constexpr int at_first = 5;
  constexpr double away = 1e3;
  if (guess_ == Guess::far && taken_ >= at_first && length > away)
    throw std::runtime_error("Newton's corrections run away");
  if (taken_ > 0) {
    // A metric that leaves out some unknowns (forces, say) may hold small corrections before larger ones on a way that
    // converges: F tells.
    constexpr double falling = 0.1;
    if (guess_ == Guess::near && contraction(length) > 1.0 && length > 10.0 * rounding && !exhausted &&
        residual > falling * previous_residual_ && !all_noise())
      throw std::runtime_error("Newton's corrections grow");
    stagnant = contraction(length) > no_longer_shrinks;
  }
  const bool done = guess_ == Guess::far ? over(length, exhausted && !falls)
                                         : stagnant && (exhausted || length <= rounding);
  // Corrections by an old factorisation shrink by a factor only. What the last one leaves is unseen in the metric, and more in
  // places that the metric gives little weight (a short arc).
  // Where they no longer shrink and F is no rounding, the old factorisation hardly knows some direction: that of the state does.
  constexpr double unseen = 1e-3;
  const double left_unseen = taken_ > 0 && length > 0.0 ? length * contraction(length) : 0.0;
  const bool old = !fresh && stagnant && !exhausted && residual > little * allowed;
  const bool quick = fresh || stagnant || left_unseen <= unseen * tolerance;
  settling_ = length <= tolerance && (old || (!quick && !done));
  const bool small = (length <= tolerance || done) && !settling_;
  // Where corrections are this small twice and F no longer falls, what is left of it is the rounding of its large terms
  // (those of an arc about to vanish, say).
  const bool rounded = taken_ > 0 && previous_ <= tolerance && length <= 0.1 * tolerance && !falls;
  // What the last correction leaves of F goes on as before: a good part of what is allowed where they converge slowly. While F
  // still falls another one is worth while.
  const double left = falls ? 0.03 : 0.1;
  const double after = taken_ > 0 ? residual * std::min(1.0, residual / previous_residual_) : 0.0;
  ++taken_;
  previous_ = length;
  previous_residual_ = residual;
  return small && (rounded || exhausted || (residual <= allowed && after <= left * allowed));
}

bool StoppingRule::is_noise(double residual) const {
  constexpr double several = 4.0;  // roundings come together
  return noise_ && residual <= several * noise_();
}

// From a far guess every correction has factors of its own: where one no longer shrinks it is rounding, magnified by what J
// nearly lacks. (On the way to a nearly singular state corrections halve, and F falls to a quarter.)
bool StoppingRule::over(double length, bool all_rounding) const {
  constexpr double hardly_shrinks = 0.3, least_visible = 1e-9;
  return taken_ > 0 && contraction(length) > hardly_shrinks && (all_rounding || length <= least_visible);
}

namespace {

void iterate(BorderedSystem& system, const Options& options, CorrectorReport& report) {
  StoppingRule rule(options, StoppingRule::Guess::near, [&] { return system.noise(); });
  double first = 0.0, first_residual = 0.0;
  for (int k = 0;; ++k) {
    const Vector& defect = system.defect();
    report.residual = system.residual();
    bool fresh = k == 0;
    if (fresh) system.factor();
    Vector delta = system.solve(defect);
    double length = system.length(delta);
    // F tells how fast it goes where the metric leaves out most of the corrections.
    if (k == 0) first = length, first_residual = report.residual;
    if (k == 1)
      report.contraction = std::min(length / first, report.residual / std::max(first_residual, 1e-300));
    if (k > 0 && rule.slow(length)) {
      system.factor();
      delta = system.solve(defect);
      length = system.length(delta);
      fresh = true;
    }
    const bool done = rule.last(length, report.residual, system.state_size(), fresh);
    report.increment = length;
    if (done && fresh && rule.negligible(length)) {
      report.factored_here = true;
    } else {
      system.add(delta);
    }
    if (done) {
      report.converged = true;
      return;
    }
    if (!rule.settling() && ++report.iterations > options.max_newton) {
      std::ostringstream message;
      message << "no convergence in " << options.max_newton << " corrections (increment " << length
              << ", residual " << report.residual << ")";
      report.failure = message.str();
      return;
    }
  }
}

}  // namespace

CorrectorReport ChordNewton::solve(Problem& problem, const Borders& borders, Iterate& iterate,
                                   const Options& options) {
  CorrectorReport report;
  BorderedSystem system(problem, borders, iterate);
  try {
    continuation::iterate(system, options, report);
  } catch (const std::domain_error& error) {
    report.failure = std::string("outside the domain: ") + error.what();
  } catch (const std::runtime_error& error) {
    report.failure = error.what();
  }
  report.factorizations = system.factorizations();
  return report;
}

}  // namespace continuation
