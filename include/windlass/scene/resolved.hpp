#pragma once

#include <string>

#include "windlass/scene/scene.hpp"

namespace windlass::scene {

/// The scene as TOML, every key written out, dimensionless; a physical one with its scales. Reading the text again
/// gives an equal Scene.
std::string to_toml(const Scene& scene);

}  // namespace windlass::scene
