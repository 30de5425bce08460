#pragma once

#include <cmath>

#include "windlass/scene/scene.hpp"

namespace windlass::test {

/// A rod of length 20 once round the cylinder, dimensionless.
inline scene::Scene coil_scene(double tension, scene::EndKind ends = scene::EndKind::moment_free) {
  scene::Scene scene;
  scene.name = "coil";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 20.0;
  scene.ends.kind = ends;
  return scene;
}

}  // namespace windlass::test
