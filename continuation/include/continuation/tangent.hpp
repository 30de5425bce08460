#pragma once

#include <string>

#include "continuation/options.hpp"
#include "continuation/problem.hpp"

namespace continuation {

/// A direction (dx, dp) in the product of increments and the varied parameter.
struct Tangent {
  Vector x;        ///< increment of the state; shape n
  double p = 0.0;  ///< increment of the varied parameter
};

/// The metric of path length, see Scales.
double inner(const Problem& problem, const Tangent& a, const Tangent& b, const Scales& scales);

/// Scales to unit length. @throws std::runtime_error when the direction is zero or not finite.
void normalise(const Problem& problem, Tangent& tangent, const Scales& scales);

/// Unit tangent at (x, p) from [J F_p; r s][t] = [0; 1] with the border r = 0, s = 1, or, where J is
/// singular, a fixed full border; dp has the sign `direction`. Factors the bordered matrix (leaving it with
/// the tangent's own border is not promised).
/// `sharp`, if asked for, is the length of (dx/dp, 1) in the metric: infinite where J is singular.
/// @throws std::runtime_error if no border makes the matrix regular.
Tangent first_tangent(Problem& problem, const Vector& x, const Vector& p, const Options& options,
                      int direction, double* sharp = nullptr);

/// Unit tangent from the last factored matrix [J F_p; dual(previous)], oriented like the previous one.
Tangent next_tangent(Problem& problem, const Scales& scales);

}  // namespace continuation
