#pragma once

#include <optional>

#include "continuation/options.hpp"
#include "continuation/point.hpp"

namespace continuation {

/// Where a fold or a branch point is on another problem, of the same branch on a finer mesh, say.
///
/// With the reduction y(λ, α) of reduced.hpp from the state given: a fold's y = y_α = 0 is, but for the square of what the
/// two problems differ by, y(λ, 0) = 0; a branch point is y_α = y_λ = 0, or, where the kernel has k > 1 dimensions,
/// tr y_α(λ, 0) = 0 as polish_branch_point() has it.
///
/// @param x,p  close to it
/// @param multiplicity  k of a branch point
/// @returns λ; nothing for other types of points, or where none is found
std::optional<double> relocated(Problem& problem, const Options& options, const Vector& x, const Vector& p,
                                PointType type, int multiplicity = 1);

}  // namespace continuation
