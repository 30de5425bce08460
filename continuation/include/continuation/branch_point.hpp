#pragma once

#include <optional>
#include <string>
#include <vector>

#include "continuation/reduced.hpp"
#include "continuation/segment.hpp"

namespace continuation {

/// A point where branches cross: J has a k-dimensional kernel and F_λ lies in its range.
struct BranchPoint {
  Vector x, p;
  Vector u;                ///< increment from the sample it was solved from
  int multiplicity = 1;    ///< k
  NullVectors null;        ///< at the point
  bool polished = false;   ///< located by the reduced equations; otherwise by bisection alone
  double precision = 0.0;  ///< of the varied parameter: the last Newton increment, or the bracket's width
  std::vector<Tangent>
      tangents;  ///< k = 1: the branch followed, then the one that crosses it; unit, either sign
};

/// Solves for the branch point between two samples of a segment, from the lower one.
///
/// k = 1: Newton's method on  y_α = y_λ = 0  in (λ, α), regular at transcritical points and pitchforks
/// alike; the second derivatives of y (differences) give the two tangents, the roots of  y_λλ dλ² + 2 y_λα
/// dλ dα + y_αα dα² = 0.
/// k > 1: the secant method on tr(Wᵀ y_α) = 0 in λ with α = 0, W = the change of y_α over the bracket; the
/// branch followed then must lie in the subspace α = 0, as symmetry makes it.
///
/// @return nullopt if there is no such point within about the bracket; `why` then says what was found
std::optional<BranchPoint> polish_branch_point(Segment& segment, const Sample& lo, const Sample& hi,
                                               int multiplicity, std::string& why);

/// The simple branch point within about `width` of a state that is close to singular. The first of its tangents is
/// the one with the larger share of the parameter.
std::optional<BranchPoint> branch_point_at(Problem& problem, const Options& options, const Vector& x,
                                           const Vector& p, double width, std::string& why);

}  // namespace continuation
