#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "windlass/scene/scene.hpp"
#include "windlass/scene/units.hpp"

/// The one table of scene keys. Reading, `--set`, defaults, error messages, suggestions, the resolved scene and
/// the help text all come from it.
namespace windlass::scene {

enum class ValueKind { number, integer, text, direction, truth };  ///< truth: true or false, as 1 or 0

/// Interval of allowed numbers, in the key's own dimension. Bounds of dimensional keys are 0 or infinite, so they
/// hold in every system of units.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  bool open_high = false;
  bool allows_infinity = false;

  bool contains(double value) const;
  std::string text() const;  ///< "> 0", ">= 0 and < 2"
};

struct Key {
  std::string_view name;  ///< dotted, e.g. "load.tension"
  ValueKind kind = ValueKind::number;
  Dimension dimension = Dimension::none;
  Range range;
  std::vector<std::string_view> choices;  ///< allowed words of a text key; empty: any text
  std::string_view help;                  ///< one line

  /// Access to the resolved, dimensionless value; null for keys that only serve to derive others (a Young's
  /// modulus becomes part of the scales). `get` is empty where the scene says nothing.
  std::optional<double> (*get)(const Scene&) = nullptr;
  void (*set)(Scene&, double) = nullptr;
  std::string (*get_text)(const Scene&) = nullptr;
  void (*set_text)(Scene&, const std::string&) = nullptr;

  bool is_parameter = false;  ///< may be continued in: part of the mechanics, not of the method
  bool is_alias =
      false;  ///< another way to give the number of another key: neither converted nor written by itself

  std::string_view table() const;    ///< "load"; empty for top-level keys
  std::string_view leaf() const;     ///< "tension"
  std::string allowed() const;       ///< "must be > 0", "must be one of ..."
  std::string default_text() const;  ///< the default as TOML; empty if there is none
};

std::span<const Key> keys();

/// Keys of each [[wall]]; a scene has any number of them, so they are no parameters and cannot be set one by one.
std::span<const Key> wall_keys();

/// Null if there is no such key.
const Key* find_key(std::string_view name);

/// The key a mistyped name most likely meant (smallest edit distance, a right last word counting most).
std::string_view nearest_key(std::string_view name);

/// True for the keys a branch can be followed in: every number that enters the mechanics.
bool is_numeric_key(std::string_view name);

/// Sets or reads such a number [dimensionless]. @throws SceneError for any other key.
void set_parameter(Scene& scene, std::string_view name, double value);
double get_parameter(const Scene& scene, std::string_view name);

/// Number as TOML and people write it: shortest text that reads back to the same double, "inf" in quotes.
std::string number_text(double value);

}  // namespace windlass::scene
