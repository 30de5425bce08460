#include "planned.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::scene {

namespace {

struct Planned {
  std::string_view key;      ///< of an entry, or of a table with all its entries
  std::string_view allowed;  ///< the value that says what holds today, as messages show it; empty: none
  std::string_view what;
};

constexpr Planned planned[] = {
    {"cylinder.friction_couple", "true", "the friction's couple"},
};

bool belongs_to(std::string_view key, std::string_view name) {
  return key == name || (key.starts_with(name) && key.substr(name.size()).starts_with('.'));
}

const Planned* find_planned(std::string_view key) {
  if (find_key(key)) return nullptr;
  const auto found = std::find_if(std::begin(planned), std::end(planned),
                                  [&](const Planned& row) { return belongs_to(key, row.key); });
  return found == std::end(planned) ? nullptr : found;
}

/// Like Entry::shown, but a word on the command line needs no quotes.
std::string as_toml(const Entry& entry) {
  const auto* text = std::get_if<std::string>(&entry.value);
  if (const auto* number = std::get_if<double>(&entry.value); number && std::isinf(*number) && *number > 0.0)
    return "\"inf\"";
  return text ? '"' + *text + '"' : entry.shown;
}

}  // namespace

void settle_planned(Document& document) {
  for (const Entry& entry : document.entries) {
    const Planned* row = find_planned(entry.key);
    if (!row || as_toml(entry) == row->allowed) continue;
    throw SceneError(
        fmt::format("{}{} not built yet; must be {}", entry.prefix(),
                    row->what == "knots" ? fmt::format("{} are", row->what) : fmt::format("{} is", row->what),
                    row->allowed.empty() ? "left out" : row->allowed));
  }
  std::erase_if(document.entries, [](const Entry& entry) { return find_planned(entry.key); });
  for (auto table = document.tables.begin(); table != document.tables.end();)
    table = belongs_to("knot", table->first) ? document.tables.erase(table) : std::next(table);
}

}  // namespace windlass::scene
