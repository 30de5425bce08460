#include "values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "windlass/scene/error.hpp"

namespace windlass::scene {

namespace {

std::optional<double> plain_number(const Entry& entry) {
  if (const auto* number = std::get_if<double>(&entry.value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&entry.value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::string allowed_text(const Key& key, Dimension dimension, const Range& range) {
  if (key.kind == ValueKind::integer) return key.allowed();
  std::string text = fmt::format("must be {}", description(dimension));
  if (range.text() != "finite") text += ", " + range.text();
  return text;
}

/// What a text that does not begin like a quantity could have been instead.
std::string or_number(const std::string& text, const Key& key) {
  const bool quantity =
      !text.empty() && std::string_view("+-.0123456789").find(text[0]) != std::string_view::npos;
  return quantity || key.name == "rod.youngs_modulus" ? "" : ", or a number in a scene without units";
}

/// Table part of a name: "load" of "load.tension".
std::string table_of(const std::string& name) {
  const auto dot = name.find('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

}  // namespace

bool is_written_with_unit(const Entry& entry, const Key& key, Dimension dimension) {
  const auto* text = std::get_if<std::string>(&entry.value);
  if (!is_dimensional(dimension) || !text || *text == "inf") return false;
  try {
    parse_quantity(*text, dimension);
  } catch (const std::invalid_argument& error) {
    throw SceneError(entry.prefix() + error.what() + or_number(*text, key));
  }
  return true;
}

void check_size(const Entry& entry, const Key& key, double dimensionless) {
  // The equations add such numbers, or their products, to moments of size EI/ρ = 1.
  constexpr double most = 1e12, least = 1e-12;
  const double size = std::abs(dimensionless);
  const bool too_small = key.is_parameter && size > 0.0 && size < least;
  if (std::isinf(dimensionless) || (size <= most && !too_small)) return;
  throw SceneError(fmt::format("{}must be {}{} {:g} in size{}", entry.prefix(),
                               key.range.text() == "finite" ? "" : key.range.text() + " and ",
                               too_small ? "at least" : "at most", too_small ? least : most,
                               is_dimensional(key.dimension) ? ", in units of EI and the length rho" : ""));
}

Number read_number(const Entry& entry, const Key& key, Dimension dimension, const Range& range) {
  Number number;
  const auto* text = std::get_if<std::string>(&entry.value);
  if (const auto plain = plain_number(entry)) {
    number.value = *plain;
  } else if (text && *text == "inf") {
    number.value = std::numeric_limits<double>::infinity();
  } else if (text && dimension != Dimension::none) {
    try {
      number.has_unit = is_dimensional(dimension);
      number.value = number.has_unit ? parse_quantity(*text, dimension) : parse_angle(*text);
    } catch (const std::invalid_argument& error) {
      throw SceneError(entry.prefix() + error.what());
    }
  } else {
    throw SceneError(entry.prefix() + allowed_text(key, dimension, range));
  }
  constexpr double largest =
      1e30;  // of SI units; beyond it products of a few such numbers leave the range of doubles
  if (number.has_unit && number.value != 0.0 &&
      !(std::abs(number.value) < largest && std::abs(number.value) > 1.0 / largest))
    throw SceneError(
        fmt::format("{}must be between {:g} and {:g} in SI units", entry.prefix(), 1.0 / largest, largest));
  const bool whole = key.kind != ValueKind::integer || number.value == std::floor(number.value);
  if (!range.contains(number.value) || !whole)
    throw SceneError(entry.prefix() +
                     (whole && key.kind != ValueKind::integer ? "must be " + range.text() : key.allowed()) +
                     (std::isfinite(number.value) || range.text() == "finite" || range.allows_infinity
                          ? ""
                          : " and finite"));
  return number;
}

std::string read_text(const Entry& entry, const Key& key) {
  const auto* text = std::get_if<std::string>(&entry.value);
  const bool known = key.choices.empty() ||
                     (text && std::find(key.choices.begin(), key.choices.end(), *text) != key.choices.end());
  if (!text || !known) throw SceneError(entry.prefix() + key.allowed());
  return *text;
}

bool read_truth(const Entry& entry, const Key& key) {
  const auto* truth = std::get_if<bool>(&entry.value);
  if (!truth) throw SceneError(entry.prefix() + key.allowed());
  return *truth;
}

void check_names(const Document& document) {
  for (const Entry& entry : document.entries)
    if (!find_key(entry.key))
      throw SceneError(
          fmt::format("{}unknown key; did you mean {}?", entry.prefix(), nearest_key(entry.key)));
  for (const auto& [table, line] : document.tables) {
    const auto all = keys();
    const auto known = [&](const Key& key) { return key.table() == table; };
    if (std::none_of(all.begin(), all.end(), known))
      throw SceneError(fmt::format("{}: [{}]: unknown table; did you mean [{}]?",
                                   document.place_of_table(table), table,
                                   table_of(std::string(nearest_key(table + ".")))));
  }
  // `cylinder = 3` leaves a top-level key, caught above; `[load.tension]` leaves a table named like a key.
}

}  // namespace windlass::scene
