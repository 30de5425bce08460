#pragma once

#include "windlass/discrete_rod/spline_rod.hpp"

namespace windlass::discrete_rod {

/// Least distance d from a place of one element to another element, as a function of the control points of both: a minimum over
/// the second place alone.
struct StrandDistance {
  Eigen::Matrix<double, 24, 1>
      slope;  ///< by the 12 coordinates of the first element's points, then the second's
  Eigen::Matrix<double, 24, 24> curvature;  ///< second derivatives
};

/// @param t        place in the first element
/// @param foot     in the second, where f = ½ d² has its minimum
/// @param distance there [ρ]
StrandDistance strand_distance(const SplineRod::Controls& here, double t, const SplineRod::Controls& there,
                               double foot, double distance);

}  // namespace windlass::discrete_rod
