#pragma once

#include "windlass/obstacle/plane.hpp"
#include "windlass/obstacle/rim.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::obstacle {

/// A plate that moves while joints stand on it, which know it by pointer: a branch in its height keeps its chain, and with it the
/// factors that Newton's method goes on with.
struct MovingPlate {
  std::shared_ptr<Plane> face;
  std::shared_ptr<Rim> edge;  ///< null: it has none
  double up = 1.0;            ///< −1: the plate is below the rod
  void move_to(double height) const;
};

/// The obstacles of a scene, in the order of its file. @param second  becomes its second plate, if it has one
Set obstacles_of(const scene::Scene& scene, MovingPlate* second = nullptr);

/// Which of a scene's plates, from 1, an obstacle is the face or the edge of; 0: none.
int plate_at(const scene::Scene& scene, int obstacle);

}  // namespace windlass::obstacle
