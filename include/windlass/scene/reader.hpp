#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "windlass/scene/error.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::scene {

/// Reads a TOML scene, applies `KEY=VALUE` overrides (as after `--set`), fills in defaults, turns units into
/// dimensionless numbers and checks everything that can be checked without solving.
/// @throws SceneError naming file, line, key, offending value and what is allowed
Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides = {});

}  // namespace windlass::scene
