#pragma once

#include <string>

#include "document.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/scene.hpp"

/// What must hold between the keys of a scene: which ones it needs, which ones exclude each other.
namespace windlass::scene {

/// `capstan.toml:5: load.angle: missing; with [cylinder] ...`, at the line of the table it belongs to.
SceneError missing(const Document& document, const std::string& key, const std::string& why);

/// @param restart  a branch begins at a stored point, wherever continuation.from is
/// @throws SceneError for the first rule that does not hold
void check_rules(const Document& document, const Scene& scene, bool restart);

}  // namespace windlass::scene
