#include "windlass/scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "windlass/scene/error.hpp"

namespace windlass::scene {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

const Key& parameter_key(std::string_view name) {
  const Key* key = find_key(name);
  if (!key || !key->is_parameter)
    throw SceneError(
        fmt::format("{}: is not a numeric key of the scene; did you mean {}?", name, nearest_key(name)));
  return *key;
}

std::string_view leaf_of(std::string_view name) { return name.substr(name.rfind('.') + 1); }

}  // namespace

bool Range::contains(double value) const {
  if (std::isnan(value)) return false;
  if (std::isinf(value)) return allows_infinity && value > 0.0;
  return (open_low ? value > low : value >= low) && (open_high ? value < high : value <= high);
}

std::string Range::text() const {
  std::string out;
  if (low != -unbounded) out = fmt::format("{} {}", open_low ? ">" : ">=", low);
  if (high != unbounded)
    out += fmt::format("{}{} {}", out.empty() ? "" : " and ", open_high ? "<" : "<=", high);
  if (out.empty()) out = "finite";
  if (allows_infinity) out += " or \"inf\"";
  return out;
}

std::string_view Key::table() const {
  const auto dot = name.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : name.substr(0, dot);
}

std::string_view Key::leaf() const { return leaf_of(name); }

std::string Key::allowed() const {
  if (kind == ValueKind::text && choices.empty()) return "must be a text";
  if (kind == ValueKind::text) return fmt::format("must be one of \"{}\"", fmt::join(choices, "\", \""));
  if (kind == ValueKind::truth) return "must be true or false";
  if (kind == ValueKind::integer) return fmt::format("must be a whole number {}", range.text());
  return fmt::format("must be {}", range.text());
}

std::string Key::default_text() const {
  static const Scene defaults = [] {
    Scene scene;
    scene.continuation.emplace();
    return scene;
  }();
  // These stand for "not given" in the struct, or have to be given.
  for (const char* none :
       {"name", "rod.length", "load.tension", "load.angle", "continuation.from", "continuation.to"})
    if (name == none) return "";
  if (kind == ValueKind::truth) return "";  // hangs on other keys
  if (get_text) {
    const std::string text = get_text(defaults);
    return text.empty() ? "" : nlohmann::json(text).dump();
  }
  const std::optional<double> value = get ? get(defaults) : std::nullopt;
  return value ? number_text(*value) : "";
}

const Key* find_key(std::string_view name) {
  for (const Key& key : keys())
    if (key.name == name) return &key;
  return nullptr;
}

std::string_view nearest_key(std::string_view name) {
  const auto distance = [name](const Key& key) {
    return 2 * edit_distance(leaf_of(name), key.leaf()) + edit_distance(name, key.name);
  };
  const auto table = keys();
  return std::min_element(table.begin(), table.end(),
                          [&](const Key& a, const Key& b) { return distance(a) < distance(b); })
      ->name;
}

bool is_numeric_key(std::string_view name) {
  const Key* key = find_key(name);
  return key && key->is_parameter;
}

void set_parameter(Scene& scene, std::string_view name, double value) {
  parameter_key(name).set(scene, value);
}

double get_parameter(const Scene& scene, std::string_view name) {
  return parameter_key(name).get(scene).value_or(0.0);
}

std::string number_text(double value) { return std::isinf(value) ? "\"inf\"" : fmt::format("{}", value); }

}  // namespace windlass::scene
