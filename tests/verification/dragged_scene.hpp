#pragma once

#include <cmath>

#include "windlass/scene/scene.hpp"

namespace windlass::test {

/// A rod once round a cylinder that slides, between clamps, held back by a plate.
inline scene::Scene clamped_on_plate(double tension, double friction, double radius, scene::Travel travel) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 2.0 * M_PI + 16.0;
  scene.rod_radius = radius;
  scene.friction = friction;
  scene.motion.sliding = scene::Sliding::up;
  scene.plate.emplace();
  scene.ends.kind = scene::EndKind::clamped;
  scene.ends.travel = travel;
  scene.model.kind = scene::ModelKind::kirchhoff;
  return scene;
}

}  // namespace windlass::test
