#include "windlass/obstacle/scene_obstacles.hpp"

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/obstacle/plane.hpp"

namespace windlass::obstacle {

Set obstacles_of(const scene::Scene& scene) {
  static const Set cylinder({unit_cylinder()});
  if (scene.has_cylinder) return cylinder;
  std::vector<SurfacePointer> walls;
  for (const scene::Wall& wall : scene.walls)
    walls.push_back(std::make_shared<const Plane>(Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]),
                                                  wall.distance));
  return walls.empty() ? Set() : Set(std::move(walls));
}

}  // namespace windlass::obstacle
