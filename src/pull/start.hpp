#pragma once

#include "windlass/equilibrium/solution.hpp"
#include "windlass/pull/dragged_rod.hpp"

namespace windlass::pull {

/// Control points of the curve that a computed state has at the knots.
DraggedRod::Vector laid_along(const discrete_rod::OpenSpline& spline, const equilibrium::Solution& state);

}  // namespace windlass::pull
