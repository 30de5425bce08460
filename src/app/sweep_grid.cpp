#include "app/sweep_grid.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

namespace {

constexpr int most_cases = 1000000;

/// "1.5 pi" as 1.5 and "pi".
struct Quantity {
  double number = 0.0;
  std::string unit;
};

std::optional<Quantity> quantity(const std::string& text) {
  char* end = nullptr;
  Quantity out{std::strtod(text.c_str(), &end), {}};
  if (end == text.c_str() || !std::isfinite(out.number)) return std::nullopt;
  while (*end == ' ') ++end;
  out.unit = end;
  return out;
}

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) c == mark ? void(parts.emplace_back()) : parts.back().push_back(c);
  return parts;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("--over " + text + ": " + why +
                   "; must be KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=A,B,..., e.g. "
                   "'load.angle=1 pi:4 pi:7'");
}

int count_of(const std::string& text, const std::string& word) {
  const auto count = quantity(word);
  if (!count || !count->unit.empty() || count->number != std::floor(count->number) || count->number < 1.0 ||
      count->number > most_cases)
    refuse(text, "the count \"" + word + "\" is not a whole number from 1 to 1000000");
  return static_cast<int>(count->number);
}

std::vector<std::string> range(const std::string& text, const std::vector<std::string>& parts) {
  if (parts.size() > 4 || parts.size() < 3 || (parts.size() == 4 && parts[3] != "log"))
    refuse(text, "a range has three parts, and perhaps \"log\"");
  const auto from = quantity(parts[0]), to = quantity(parts[1]);
  if (!from) refuse(text, "\"" + parts[0] + "\" is not a number");
  if (!to) refuse(text, "\"" + parts[1] + "\" is not a number");
  if (!from->unit.empty() && from->unit != to->unit)
    refuse(text, "\"" + from->unit + "\" and \"" + to->unit + "\" are different units");
  const int count = count_of(text, parts[2]);
  const bool log = parts.size() == 4;
  if (log && !(from->number > 0.0 && to->number > 0.0)) refuse(text, "equal ratios need numbers above 0");
  std::vector<std::string> values;
  for (int k = 0; k < count; ++k) {
    const double at = count > 1 ? static_cast<double>(k) / (count - 1) : 0.0;
    double value = from->number + (to->number - from->number) * at;
    if (log) value = k + 1 == count ? to->number : from->number * std::pow(to->number / from->number, at);
    values.push_back(scene::number_text(value) + (to->unit.empty() ? "" : " " + to->unit));
  }
  return values;
}

}  // namespace

SweepAxis parse_axis(const std::string& text) {
  const std::size_t mark = text.find('=');
  if (mark == std::string::npos) refuse(text, "there is no '='");
  SweepAxis axis{text.substr(0, mark), {}};
  const scene::Key* key = scene::find_key(axis.key);
  if (!key)
    throw InputError("--over " + text + ": unknown key " + axis.key + "; did you mean " +
                     std::string(scene::nearest_key(axis.key)) + "?");
  if (key->kind == scene::ValueKind::text || key->kind == scene::ValueKind::truth)
    refuse(text, axis.key + " is no number");
  const std::vector<std::string> parts = split(text.substr(mark + 1), ':');
  axis.values = parts.size() > 1 ? range(text, parts) : split(parts.front(), ',');
  for (const std::string& value : axis.values)
    if (value != "inf" && !quantity(value)) refuse(text, "\"" + value + "\" is not a number");
  return axis;
}

SweepGrid::SweepGrid(std::vector<SweepAxis> axes) : axes_(std::move(axes)) {
  if (axes_.empty()) throw InputError("a sweep needs at least one --over KEY=FROM:TO:COUNT");
  double cases = 1.0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    cases *= static_cast<double>(axes_[a].values.size());
    for (std::size_t b = 0; b < a; ++b)
      if (axes_[a].key == axes_[b].key) throw InputError("--over " + axes_[a].key + ": stands there twice");
  }
  if (cases > most_cases) throw InputError("the sweep has more than a million cases");
  size_ = static_cast<int>(cases);
}

std::vector<std::string> SweepGrid::values(int number) const {
  std::vector<std::string> out(axes_.size());
  for (std::size_t a = axes_.size(); a-- > 0; number /= static_cast<int>(axes_[a].values.size()))
    out[a] = axes_[a].values[number % axes_[a].values.size()];
  return out;
}

std::vector<std::string> SweepGrid::settings(int number) const {
  std::vector<std::string> out = values(number);
  for (std::size_t a = 0; a < axes_.size(); ++a) out[a].insert(0, axes_[a].key + "=");
  return out;
}

}  // namespace windlass::app
