#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

namespace fs = std::filesystem;

/// WINDLASS_SCENES names another place; an installed program (PREFIX/bin/windlass) has them in PREFIX/share; else they
/// stand beside the sources the program was built from.
fs::path scenes_folder() {
  if (const char* place = std::getenv("WINDLASS_SCENES"); place && *place) return place;
  std::error_code ignored;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "share/windlass/scenes";
  if (fs::is_directory(installed, ignored)) return installed;
  return fs::path(WINDLASS_SCENES_FOLDER);
}

namespace {

std::vector<fs::path> scene_files(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw InputError(folder.string() + ": the folder of shipped scenes is not there");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void list_scenes(const CommonOptions& common) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const fs::path& file : scene_files(scenes_folder())) {
    const scene::Scene scene = scene::read_scene(file);
    const fs::path shown = fs::proximate(file);
    if (common.json)
      list.push_back({{"name", scene.name}, {"file", shown.string()}, {"title", scene.title}});
    else
      fmt::print("{:<44}  {}\n", shown.string(), scene.title);
  }
  if (common.json) fmt::print("{}\n", list.dump(2));
}

std::string unit_text(const scene::Key& key) {
  if (key.kind == scene::ValueKind::text) return "text";
  if (key.kind == scene::ValueKind::integer) return "whole number";
  if (key.kind == scene::ValueKind::truth) return "true or false";
  if (key.kind == scene::ValueKind::direction) return "three numbers";
  switch (key.dimension) {
    case scene::Dimension::angle:
      return "angle";
    case scene::Dimension::length:
      return "length";
    case scene::Dimension::curvature:
      return "curvature";
    case scene::Dimension::force:
      return "force or hung mass";
    case scene::Dimension::compliance:
      return "1/force";
    case scene::Dimension::distributed:
      return "force per length";
    case scene::Dimension::stiffness:
      return "bending stiffness";
    case scene::Dimension::modulus:
      return "pressure";
    case scene::Dimension::of_parameter:
      return "as the parameter";
    default:
      return "number";
  }
}

void list_keys() {
  fmt::print("{:<26} {:<19} {:<13} {}\n", "key", "value", "default", "meaning");
  const auto print = [](const scene::Key& key) {
    fmt::print("{:<26} {:<19} {:<13} {}", key.name, unit_text(key), key.default_text(), key.help);
    if (!key.choices.empty() || (key.kind != scene::ValueKind::text && key.kind != scene::ValueKind::truth &&
                                 key.range.text() != "finite"))
      fmt::print("; {}", key.allowed());
    fmt::print("\n");
  };
  for (const scene::Key& key : scene::keys())
    if (key.table() != "scale") print(key);  // only the program writes those
  for (const scene::Key& key : scene::wall_keys()) print(key);
}

}  // namespace

void add_scenes(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("scenes", "the scenes that come with the program, one line each");
  const auto show_keys = std::make_shared<bool>(false);
  command.add_flag("--keys", *show_keys, "list every scene key with its default and allowed range instead");
  command.add_flag("--json", common.json, "as JSON");
  command.run([show_keys, &common, &status] {
    *show_keys ? list_keys() : list_scenes(common);
    status = done;
  });
}

}  // namespace windlass::app
