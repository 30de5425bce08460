#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "windlass/obstacle/surface.hpp"

namespace windlass::output {

/// Corners of a flat obstacle's surface, as large as the box (of a rod) asks for: a radius of the rod behind the
/// plane at which its centre line is stopped. Empty for obstacles that are not flat.
inline std::vector<Eigen::Vector3d> sheet_of(const obstacle::Surface& obstacle,
                                             const Eigen::AlignedBox3d& box, double rod_radius) {
  std::vector<Eigen::Vector3d> corners = obstacle.sheet(box);
  for (Eigen::Vector3d& corner : corners) corner -= rod_radius * obstacle.normal(corner);
  return corners;
}

}  // namespace windlass::output
