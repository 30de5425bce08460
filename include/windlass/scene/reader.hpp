#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "windlass/scene/error.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::scene {

struct ReadOptions {
  /// A stored point says where a branch begins: continuation.from of the file is that of the run it was stored in.
  bool restart = false;
};

/// Reads a TOML scene, applies `KEY=VALUE` overrides (as after `--set`), fills in defaults, turns units into
/// dimensionless numbers and checks everything that can be checked without solving.
/// @throws SceneError naming file, line, key, offending value and what is allowed
Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides = {},
                 const ReadOptions& options = {});

}  // namespace windlass::scene
