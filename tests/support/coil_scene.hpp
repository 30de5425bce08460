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

/// A thick rod of length 40 once round the cylinder, R/r = 2.5, that keeps apart from itself.
inline scene::Scene thick_coil_scene() {
  scene::Scene scene = coil_scene(2.0);
  scene.name = "thick";
  scene.rod.length = 40.0;
  scene.rod_radius = 2.0 / 7.0;
  scene.self_contact = true;
  return scene;
}

}  // namespace windlass::test
