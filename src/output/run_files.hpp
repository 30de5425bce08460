#pragma once

/// Names of the files of a run folder.
namespace windlass::output {

inline constexpr const char* scene_file = "scene.toml";
inline constexpr const char* info_file = "run.json";
inline constexpr const char* branches_file = "branches.csv";
inline constexpr const char* special_file = "special_points.json";
inline constexpr const char* points_file = "points.h5";
inline constexpr const char* checkpoint_file = "checkpoint.cbor";

}  // namespace windlass::output
