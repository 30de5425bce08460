#include "approach.hpp"

#include <algorithm>

#include "continuation/corrector.hpp"

namespace continuation {

Borders fixed_parameter(const Problem& problem, const Options& options) {
  Borders fixed;
  fixed.parameter = options.parameter;
  fixed.scale = options.parameter_scale;
  fixed.psi = Matrix(problem.size(), 0);
  fixed.c = Matrix::Zero(problem.size(), 1);
  fixed.d = Matrix::Ones(1, 1);
  fixed.g = Vector::Zero(1);
  fixed.state_scale = options.state_scale;
  return fixed;
}

Approach::Approach(Problem& problem, const Vector& guess, const Vector& p, const Options& options)
    : problem_(problem), guess_(guess), p_(p), options_(options) {
  options_.max_newton = std::max(options_.max_newton, 15);
}

CorrectorReport Approach::solve_at(double value, Iterate& it, bool as_proposed) const {
  Vector at = p_;
  at[options_.parameter] = value;
  it = {guess_, Vector::Zero(problem_.size()), at, Vector::Zero(1)};
  if (as_proposed) {
    CorrectorReport report;
    report.converged = is_solution(problem_, guess_, at, options_);
    report.failure = "the state proposed is no solution";
    return report;
  }
  return correct(problem_, fixed_parameter(problem_, options_), it, options_);
}

std::vector<double> Approach::values(const Transition& transition, int& direction, double step) {
  const double here = p_[options_.parameter];
  std::vector<double> out;
  if (transition.p.size() == p_.size()) {
    const double beside = transition.p[options_.parameter];
    out.push_back(beside);
    if (beside != here) direction = beside < here ? -1 : 1;
  }
  out.push_back(here);
  for (const int sign : {direction, -direction}) {
    for (const double size : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) out.push_back(here + sign * size * step);
  }
  out.push_back(transition.p.size() == p_.size() ? transition.p[options_.parameter] : here);
  return out;
}

}  // namespace continuation
