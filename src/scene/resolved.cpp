#include "windlass/scene/resolved.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "windlass/scene/keys.hpp"

namespace windlass::scene {

namespace {

/// A JSON string is a TOML basic string; whatever is not UTF-8 on the command line is replaced.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool applies(const Scene& scene, const Key& key) {
  if (key.name == "load.tension" || key.name == "load.angle") return scene.has_cylinder;
  if (key.name == "load.thrust" || key.name == "ends.shortening" || key.name == "ends.twist")
    return !scene.has_cylinder;
  if (key.name == "cylinder.sliding" || key.name == "ends.travel") return scene.has_cylinder;
  return key.table() != "continuation" || scene.continuation;
}

}  // namespace

std::string to_toml(const Scene& scene) {
  std::string out = "# written by windlass: every value resolved, numbers dimensionless\n";
  std::string table;
  for (const Key& key : keys()) {
    if (key.is_alias || !applies(scene, key)) continue;
    std::string value;
    if (const std::string text = key.get_text ? key.get_text(scene) : ""; !text.empty()) value = quoted(text);
    if (const auto number = key.get ? key.get(scene) : std::nullopt)
      value = key.kind != ValueKind::truth ? number_text(*number) : *number != 0.0 ? "true" : "false";
    const bool opens =
        key.table() != table && (!value.empty() || (key.table() == "cylinder" && scene.has_cylinder));
    if (opens) out += fmt::format("\n[{}]\n", table = key.table());
    if (!value.empty()) out += fmt::format("{} = {}\n", key.leaf(), value);
  }
  for (const Wall& wall : scene.walls)
    out += fmt::format("\n[[wall]]\nnormal = [{}, {}, {}]\ndistance = {}\n", wall.normal[0], wall.normal[1],
                       wall.normal[2], number_text(wall.distance));
  if (scene.units)
    out += fmt::format("\n[scale]\nlength = {}\nbending_stiffness = {}\n", number_text(scene.units->length),
                       number_text(scene.units->bending_stiffness));
  return out;
}

}  // namespace windlass::scene
