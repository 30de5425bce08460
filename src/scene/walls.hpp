#pragma once

#include <vector>

#include "document.hpp"
#include "windlass/scene/scene.hpp"

/// The [[wall]] tables of a scene.
namespace windlass::scene {

/// @throws SceneError where walls are written otherwise, as [wall] or on the command line
void refuse_single_wall(const Document& document);

/// @param scene     resolved but for its walls
/// @param physical  lengths have units
/// @throws SceneError
std::vector<Wall> read_walls(const Document& document, const Scene& scene, bool physical);

}  // namespace windlass::scene
