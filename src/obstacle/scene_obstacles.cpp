#include "windlass/obstacle/scene_obstacles.hpp"

#include <cmath>

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/obstacle/plane.hpp"
#include "windlass/obstacle/rim.hpp"

namespace windlass::obstacle {

Set obstacles_of(const scene::Scene& scene) {
  static const Set cylinder({unit_cylinder()});
  if (scene.plate) {
    const scene::Plate& plate = *scene.plate;
    const bool above = plate.side == scene::PlateSide::above;
    const double up = above ? 1.0 : -1.0;
    std::vector<SurfacePointer> all{
        unit_cylinder(),
        std::make_shared<const Plane>(Vector3d(0.0, 0.0, up), up * plate.height, plate.outer_radius)};
    if (std::isfinite(plate.outer_radius))  // its edge comes next to it
      all.push_back(std::make_shared<const Rim>(plate.outer_radius, plate.height, above, scene.rod_radius));
    return Set(std::move(all));
  }
  if (scene.has_cylinder) return cylinder;
  std::vector<SurfacePointer> walls;
  for (const scene::Wall& wall : scene.walls)
    walls.push_back(std::make_shared<const Plane>(Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]),
                                                  wall.distance));
  return walls.empty() ? Set() : Set(std::move(walls));
}

}  // namespace windlass::obstacle
