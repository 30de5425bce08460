#include "windlass/obstacle/scene_obstacles.hpp"

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/obstacle/plane.hpp"

namespace windlass::obstacle {

Set obstacles_of(const scene::Scene& scene) {
  static const Set cylinder({unit_cylinder()});
  if (scene.plate) {
    const double up = scene.plate->side == scene::PlateSide::above ? 1.0 : -1.0;
    return Set(
        {unit_cylinder(), std::make_shared<const Plane>(Vector3d(0.0, 0.0, up), up * scene.plate->height,
                                                        scene.plate->outer_radius)});
  }
  if (scene.has_cylinder) return cylinder;
  std::vector<SurfacePointer> walls;
  for (const scene::Wall& wall : scene.walls)
    walls.push_back(std::make_shared<const Plane>(Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]),
                                                  wall.distance));
  return walls.empty() ? Set() : Set(std::move(walls));
}

}  // namespace windlass::obstacle
