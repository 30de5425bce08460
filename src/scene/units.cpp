#include "windlass/scene/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "windlass/scene/keys.hpp"

namespace windlass::scene {

namespace {

constexpr double standard_gravity = 9.80665;  // m/s², turns a hung mass into a pull

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Takes a number off the front of the text; empty and nothing taken if there is none.
std::optional<double> take_number(std::string_view& text) {
  std::string_view rest = trim(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value))
    return std::nullopt;  // "inf" and "nan" are no quantities
  text = trim(rest.substr(end - rest.data()));
  return value;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text = trim(text.substr(word.size()));
  return true;
}

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

/// The unit database is read once, and only for scenes that have units: it costs a few milliseconds.
ut_system* unit_system() {
  static const std::unique_ptr<ut_system, decltype(&ut_free_system)> system = [] {
    ut_set_error_message_handler(ut_ignore);
    return std::unique_ptr<ut_system, decltype(&ut_free_system)>(ut_read_xml(nullptr), ut_free_system);
  }();
  if (!system) throw std::runtime_error("the unit database of udunits2 cannot be read");
  return system.get();
}

Unit parse_unit(std::string_view name) {
  return Unit(ut_parse(unit_system(), std::string(name).c_str(), UT_UTF8), ut_free);
}

/// Empty if the two are not of the same kind.
std::optional<double> convert(double value, const Unit& from, const char* si_name) {
  const Unit si = parse_unit(si_name);
  // udunits would also convert a length to a curvature, by its reciprocal.
  const Unit ratio(ut_divide(from.get(), si.get()), ut_free);
  if (!ratio || !ut_is_dimensionless(ratio.get())) return std::nullopt;
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(ut_get_converter(from.get(), si.get()),
                                                                    cv_free);
  if (!converter) return std::nullopt;
  return cv_convert_double(converter.get(), value);
}

const char* si_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "m";
    case Dimension::curvature:
      return "m-1";
    case Dimension::force:
      return "N";
    case Dimension::compliance:
      return "N-1";
    case Dimension::distributed:
      return "N m-1";
    case Dimension::stiffness:
      return "N m2";
    case Dimension::modulus:
      return "Pa";
    default:
      throw std::logic_error("a dimension without a unit");
  }
}

}  // namespace

bool is_dimensional(Dimension dimension) {
  return dimension != Dimension::none && dimension != Dimension::angle &&
         dimension != Dimension::of_parameter;
}

std::string_view description(Dimension dimension) {
  switch (dimension) {
    case Dimension::angle:
      return "an angle such as \"2 pi\", \"90 deg\" or a number in radians";
    case Dimension::length:
      return "a length such as \"4 mm\"";
    case Dimension::curvature:
      return "a curvature such as \"20 1/m\"";
    case Dimension::force:
      return "a force such as \"2 N\" or a hung mass such as \"500 g\"";
    case Dimension::compliance:
      return "a compliance such as \"0.01 1/N\"";
    case Dimension::distributed:
      return "a force per length such as \"0.5 N/m\"";
    case Dimension::stiffness:
      return "a bending stiffness such as \"0.4e-3 N m^2\"";
    case Dimension::modulus:
      return "a pressure such as \"1.2 MPa\"";
    default:
      return "a number";
  }
}

double parse_angle(std::string_view text) {
  std::string_view rest = trim(text);
  const bool negative = take_word(rest, "-");
  const std::optional<double> number = take_number(rest);
  double value = number.value_or(1.0);
  const bool star = number && take_word(rest, "*");
  bool unit = true;
  if (take_word(rest, "pi") || take_word(rest, "π")) {
    value *= std::numbers::pi;
  } else if (take_word(rest, "degrees") || take_word(rest, "degree") || take_word(rest, "deg") ||
             take_word(rest, "°")) {
    value *= std::numbers::pi / 180.0;
  } else if (take_word(rest, "turns") || take_word(rest, "turn")) {
    value *= 2.0 * std::numbers::pi;
  } else if (!take_word(rest, "rad")) {
    unit = false;
  }
  bool complete = (number || unit) && (unit || !star);
  if (take_word(rest, "/")) {
    const std::optional<double> divisor = take_number(rest);
    complete = complete && divisor && *divisor != 0.0;
    value /= divisor.value_or(1.0);
  }
  if (!complete || !rest.empty())
    throw std::invalid_argument(fmt::format("must be {}", description(Dimension::angle)));
  return negative ? -value : value;
}

double parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = text;
  const std::optional<double> number = take_number(rest);
  if (!number || rest.empty()) throw std::invalid_argument(fmt::format("must be {}", description(dimension)));
  const Unit unit = parse_unit(rest);
  if (!unit)
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a known unit; must be {}", rest, description(dimension)));
  if (const auto value = convert(*number, unit, si_unit(dimension))) return *value;
  if (dimension == Dimension::force) {
    if (const auto mass = convert(*number, unit, "kg")) return *mass * standard_gravity;
  }
  throw std::invalid_argument(fmt::format("must be {}", description(dimension)));
}

double scale_of(const Units& units, Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return units.length;
    case Dimension::curvature:
      return 1.0 / units.length;
    case Dimension::force:
      return units.force;
    case Dimension::compliance:
      return 1.0 / units.force;
    case Dimension::distributed:
      return units.pressure;
    case Dimension::stiffness:
      return units.bending_stiffness;
    default:
      return 1.0;
  }
}

Units Units::of(double length, double bending_stiffness) {
  Units units;
  units.length = length;
  units.bending_stiffness = bending_stiffness;
  units.moment = units.energy = bending_stiffness / length;
  units.force = units.moment / length;
  units.pressure = units.force / length;
  return units;
}

Units natural_units(const Scene& scene) {
  // Of a knot round nothing the length is tails, for the most part, as that of a rod round a cylinder.
  constexpr double twentieth = 0.05;
  const double length = scene.has_cylinder  ? 1.0
                        : scene.knot.tied() ? twentieth * scene.rod.length
                                            : scene.rod.length;
  return Units::of(length, scene.rod.bending_stiffness);
}

Scene in_units(Scene scene, const Units& units) {
  const Key* parameter = scene.continuation ? find_key(scene.continuation->parameter) : nullptr;
  for (const Key& key : keys()) {
    if (!key.get || !key.set || key.is_alias) continue;
    const bool of_parameter = key.dimension == Dimension::of_parameter;
    if (of_parameter && !parameter) continue;
    const double scale = scale_of(units, of_parameter ? parameter->dimension : key.dimension);
    if (scale == 1.0) continue;
    if (const std::optional<double> value = key.get(scene)) key.set(scene, *value / scale);
  }
  for (Wall& wall : scene.walls) wall.distance /= units.length;
  scene.solved_in = Units::of(scene.solved_in.length * units.length,
                              scene.solved_in.bending_stiffness * units.bending_stiffness);
  return scene;
}

Scene natural(const Scene& scene) { return in_units(scene, natural_units(scene)); }

Scene as_given(const Scene& solved) {
  return in_units(solved, Units::of(1.0 / solved.solved_in.length, 1.0 / solved.solved_in.bending_stiffness));
}

double as_given(const Scene& solved, std::string_view key, double value) {
  const Key* known = find_key(key);
  return known ? value * scale_of(solved.solved_in, known->dimension) : value;
}

bool Rod::infinite() const { return std::isinf(length); }

}  // namespace windlass::scene
