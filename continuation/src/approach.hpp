#pragma once

#include <vector>

#include "continuation/bordered_newton.hpp"
#include "continuation/problem.hpp"

namespace continuation {

/// Borders that hold the parameter where it is.
Borders fixed_parameter(const Problem& problem, const Options& options);

/// Solves a new problem beside the event that led to it, from the state that was proposed.
class Approach {
 public:
  /// The problem must stay while this is in use. @param p  at the event
  Approach(Problem& problem, const Vector& guess, const Vector& p, const Options& options);

  /// With the parameter held at a value. @param as_proposed  the state that was proposed, if it is a solution: one that was
  /// solved for otherwise, the length of a new arc held and p free, may be beyond Newton's reach at a fixed p
  CorrectorReport solve_at(double value, Iterate& it, bool as_proposed) const;

  /// Values of the parameter in the order in which they are tried: where the state was proposed, the event itself, a little
  /// beside it, and last the first again, for the state as it was proposed.
  /// @param direction  of the parameter; becomes the one away from the event
  /// @param step       the walk's, in the parameter
  std::vector<double> values(const Transition& transition, int& direction, double step);

 private:
  Problem& problem_;
  Vector guess_, p_;
  Options options_;
};

}  // namespace continuation
