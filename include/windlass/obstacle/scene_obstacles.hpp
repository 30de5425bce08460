#pragma once

#include "windlass/obstacle/surface.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::obstacle {

/// The obstacles of a scene, in the order of its file.
Set obstacles_of(const scene::Scene& scene);

}  // namespace windlass::obstacle
