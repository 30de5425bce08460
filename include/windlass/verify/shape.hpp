#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "windlass/scene/scene.hpp"

namespace windlass::verify {

/// What the rod may touch, by its own formulas: the unit cylinder, √(x² + y²) − 1, or a plane wall, distance − n·r.
class Shape {
 public:
  static Shape cylinder() { return {}; }
  static Shape of(const scene::Wall& wall);

  double gap(const Eigen::Vector3d& r) const;
  Eigen::Vector3d outward(const Eigen::Vector3d& r) const;  ///< direction of the contact force on the rod
  /// Second derivative of the gap along a unit tangent t, but for the part that the curvature of the rod has.
  double bend(const Eigen::Vector3d& r, const Eigen::Vector3d& t) const;
  /// The outward normal of a wall, the same everywhere.
  const std::optional<Eigen::Vector3d>& wall() const { return normal_; }

 private:
  std::optional<Eigen::Vector3d> normal_;  ///< of a wall: −n
  double distance_ = 0.0;
};

/// All shapes of a scene, in the order that contacts name them by.
std::vector<Shape> shapes_of(const scene::Scene& scene);

}  // namespace windlass::verify
