#pragma once

#include <optional>
#include <vector>

#include "windlass/equilibrium/solution.hpp"

namespace windlass::output {

/// A rod made dense enough to draw: cubics through the stored samples of each arc, whose slopes are known from
/// r' = d3, n' = −p N (N the outward normal) and m' = n × d3; frames by spherical interpolation.
struct RodCurve {
  std::vector<double> s;              ///< [ρ]
  std::vector<Eigen::Vector3d> r;     ///< [ρ]
  std::vector<Eigen::Quaterniond> q;  ///< body→world, d3 = tangent
  std::vector<Eigen::Vector3d> n;     ///< [EI/ρ²]
  std::vector<Eigen::Vector3d> m;     ///< [EI/ρ]
  std::vector<double> p;              ///< [EI/ρ³]
  std::vector<std::size_t> arc;       ///< which arc a place belongs to; both sides of a joint are present
};

struct PointForce {
  double s = 0.0;                ///< [ρ]
  Eigen::Vector3d r, direction;  ///< outward normal, the direction of the force on the rod
  double size = 0.0;             ///< [EI/ρ²]
  std::optional<double> partner =
      std::nullopt;  ///< of a force of another strand: where that one is touched [ρ]
};

/// @param spacing  largest distance of neighbouring places [ρ], where it needs less than 40 places a sample
RodCurve dense_curve(const equilibrium::Solution& solution, double spacing = 0.03);

/// Touches and edges, and the places where strands touch each other, with their forces on the rod.
std::vector<PointForce> point_forces(const equilibrium::Solution& solution);

}  // namespace windlass::output
