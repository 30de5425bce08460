#include "windlass/obstacle/scene_obstacles.hpp"

#include <cmath>

#include "windlass/obstacle/cylinder.hpp"

namespace windlass::obstacle {

namespace {

MovingPlate made_of(const scene::Plate& plate, double rod_radius) {
  const bool above = plate.side == scene::PlateSide::above;
  MovingPlate out;
  out.up = above ? 1.0 : -1.0;
  out.face = std::make_shared<Plane>(Vector3d(0.0, 0.0, out.up), out.up * plate.height, plate.outer_radius);
  if (std::isfinite(plate.outer_radius))
    out.edge = std::make_shared<Rim>(plate.outer_radius, plate.height, above, rod_radius);
  return out;
}

}  // namespace

void MovingPlate::move_to(double height) const {
  if (face) face->move_to(up * height);
  if (edge) edge->move_to(height);
}

Set obstacles_of(const scene::Scene& scene, MovingPlate* second) {
  static const Set cylinder({unit_cylinder()});
  if (scene.plate) {
    std::vector<SurfacePointer> all{unit_cylinder()};
    for (const scene::Plate& plate : scene.plates()) {
      const MovingPlate one = made_of(plate, scene.rod_radius);
      if (second) *second = one;  // the last stays
      all.push_back(one.face);
      if (one.edge) all.push_back(one.edge);  // next to it
    }
    return Set(std::move(all));
  }
  if (scene.has_cylinder) return cylinder;
  std::vector<SurfacePointer> walls;
  for (const scene::Wall& wall : scene.walls)
    walls.push_back(std::make_shared<const Plane>(Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]),
                                                  wall.distance));
  return walls.empty() ? Set() : Set(std::move(walls));
}

int plate_at(const scene::Scene& scene, int obstacle) {
  int next = 1, number = 0;
  for (const scene::Plate& plate : scene.plates()) {
    next += std::isfinite(plate.outer_radius) ? 2 : 1;
    ++number;
    if (obstacle > 0 && obstacle < next) return number;
  }
  return 0;
}

}  // namespace windlass::obstacle
