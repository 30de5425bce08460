#include "walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "values.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::scene {

double Wall::reach_of_straight(double length) const {
  return 0.5 * length * std::abs(normal[0]) / std::hypot(normal[0], normal[1], normal[2]);
}

bool Scene::obstacles_keep_half_turn() const {
  return !plate &&
         std::all_of(walls.begin(), walls.end(), [](const Wall& wall) { return wall.keeps_half_turn(); });
}

std::span<const Key> wall_keys() {
  static const std::vector<Key> keys = {
      {.name = "wall.normal",
       .kind = ValueKind::direction,
       .range = {},
       .choices = {},
       .help =
           "one [[wall]] each: the centre line of a strut stays where n.r <= distance, n along the normal"},
      {.name = "wall.distance",
       .dimension = Dimension::length,
       .range = {},
       .choices = {},
       .help = "of the wall from the strut's mid-point, beyond the reach of the straight strut"},
  };
  return keys;
}

namespace {

constexpr std::string_view table = "wall";

std::array<double, 3> read_normal(const Entry& entry) {
  std::array<double, 3> normal{};
  const bool three = entry.numbers.size() == normal.size();
  if (three) std::copy(entry.numbers.begin(), entry.numbers.end(), normal.begin());
  const double size = three ? std::hypot(normal[0], normal[1], normal[2]) : 0.0;
  constexpr double least = 1e-12, most = 1e12;
  if (!(size >= least && size <= most))
    throw SceneError(entry.prefix() + "must be three numbers, not all 0, such as [0.0, 1.0, 0.0]");
  return normal;
}

double read_distance(const Entry& entry, const Scene& scene, bool physical) {
  const Key& key = wall_keys()[1];
  const Number number = read_number(entry, key, key.dimension, key.range);
  if (physical && !number.has_unit && number.value != 0.0)
    throw SceneError(fmt::format("{}must be {}, like the other quantities of this scene", entry.prefix(),
                                 description(key.dimension)));
  if (number.has_unit && !scene.units)
    throw SceneError(entry.prefix() +
                     "must be a number without a unit, like the other quantities of this scene");
  const double value = number.has_unit ? number.value / scale_of(*scene.units, key.dimension) : number.value;
  check_size(entry, key, value);
  return value;
}

Wall read_wall(const std::vector<Entry>& entries, const Document& document, const Scene& scene,
               bool physical) {
  Wall wall;
  const Entry *normal = nullptr, *distance = nullptr;
  for (const Entry& entry : entries) {
    if (entry.key == wall_keys()[0].name)
      normal = &entry;
    else if (entry.key == wall_keys()[1].name)
      distance = &entry;
    else
      throw SceneError(entry.prefix() + "unknown key; a [[wall]] has normal and distance");
  }
  if (!normal || !distance)
    throw SceneError(fmt::format("{}: wall.{}: missing; a [[wall]] has normal and distance",
                                 entries.empty() ? document.file : entries.front().place,
                                 normal ? "distance" : "normal"));
  if (scene.has_cylinder)
    throw SceneError(normal->prefix() + "walls beside a [cylinder] are not built yet; must be left out");
  wall.normal = read_normal(*normal);
  wall.distance = read_distance(*distance, scene, physical);
  const double reach = wall.reach_of_straight(scene.rod.length);
  if (!(wall.distance > reach))
    throw SceneError(fmt::format("{}must be > {}: the straight strut would reach through the wall",
                                 distance->prefix(), number_text(reach)));
  return wall;
}

}  // namespace

void refuse_single_wall(const Document& document) {
  for (const Entry& entry : document.entries)
    if (entry.key == table || entry.key.starts_with("wall."))
      throw SceneError(entry.prefix() +
                       "must be given in the scene file, in a table [[wall]] with normal and distance");
}

std::vector<Wall> read_walls(const Document& document, const Scene& scene, bool physical) {
  std::vector<Wall> walls;
  for (const std::vector<Entry>& entries : document.walls)
    walls.push_back(read_wall(entries, document, scene, physical));
  return walls;
}

}  // namespace windlass::scene
