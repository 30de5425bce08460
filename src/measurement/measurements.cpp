#include "windlass/measurement/measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::measurement {

namespace {

constexpr std::string_view allowed_columns = "must be T, F0 or F0_error, with a unit as in \"T [g]\"";

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A place in the file, for messages.
struct Place {
  const std::filesystem::path& path;
  int line;
  std::size_t column = 0;  ///< from 0

  [[noreturn]] void refuse(std::string_view text, std::string_view why) const {
    throw InputError(fmt::format("{}:{}: column {}: \"{}\": {}", path.string(), line, column + 1, text, why));
  }
};

struct Column {
  std::string name;
  double scale = 1.0;  ///< what a number of the column is multiplied with to be dimensionless
};

Column read_heading(std::string_view cell, const std::optional<scene::Units>& units, const Place& place) {
  Column column;
  const auto bracket = cell.find('[');
  column.name = trim(cell.substr(0, bracket));
  if (column.name != "T" && column.name != "F0" && column.name != "F0_error")
    place.refuse(cell, allowed_columns);
  if (bracket == std::string_view::npos) return column;
  if (cell.back() != ']') place.refuse(cell, "the unit's bracket is not closed");
  const std::string_view unit = trim(cell.substr(bracket + 1, cell.size() - bracket - 2));
  if (unit == "1" || unit == "-") return column;
  if (!units)
    place.refuse(cell, "has a unit, but the scene is dimensionless; give T and F0 in units of EI/ρ², as \"" +
                           column.name + "\"");
  try {
    column.scale = scene::parse_quantity(fmt::format("1 {}", unit), scene::Dimension::force) / units->force;
  } catch (const std::invalid_argument& error) {
    place.refuse(cell, error.what());
  }
  return column;
}

std::vector<Column> read_header(const std::string& line, const std::optional<scene::Units>& units,
                                Place place) {
  std::vector<Column> columns;
  for (const std::string& cell : output::split_csv(line)) {
    Column column = read_heading(trim(cell), units, place);
    if (std::any_of(columns.begin(), columns.end(), [&](const Column& c) { return c.name == column.name; }))
      place.refuse(trim(cell), "stands there twice");
    columns.push_back(std::move(column));
    ++place.column;
  }
  for (const char* needed : {"T", "F0"})
    if (std::none_of(columns.begin(), columns.end(), [&](const Column& c) { return c.name == needed; }))
      throw InputError(fmt::format("{}:{}: the header has no column {}; {}", place.path.string(), place.line,
                                   needed, allowed_columns));
  return columns;
}

double read_number(std::string_view cell, const Column& column, const Place& place) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    place.refuse(cell, column.name + " must be a number");
  if (column.name != "F0" && !(value > 0.0)) place.refuse(cell, column.name + " must be > 0");
  return value * column.scale;
}

Measurement read_row(const std::string& line, const std::vector<Column>& columns, Place place) {
  const std::vector<std::string> cells = output::split_csv(line);
  if (cells.size() != columns.size())
    throw InputError(fmt::format("{}:{}: has {} cells; the header names {} columns", place.path.string(),
                                 place.line, cells.size(), columns.size()));
  Measurement row;
  row.line = place.line;
  for (place.column = 0; place.column < cells.size(); ++place.column) {
    const Column& column = columns[place.column];
    const double value = read_number(trim(cells[place.column]), column, place);
    if (column.name == "T") row.T = value;
    if (column.name == "F0") row.F0 = value;
    if (column.name == "F0_error") row.F0_error = value;
  }
  return row;
}

}  // namespace

std::vector<Measurement> read_measurements(const std::filesystem::path& path,
                                           const std::optional<scene::Units>& units) {
  if (std::filesystem::is_directory(path))
    throw InputError(path.string() + ": is a directory; a CSV file was expected");
  std::string text;
  try {
    text = output::read_file(path);
  } catch (const output::OutputError& error) {
    throw InputError(error.what());
  }
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // the mark spreadsheets put before UTF-8
  std::vector<Column> columns;
  std::vector<Measurement> rows;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string_view content = trim(line);
    if (content.empty() || content.front() == '#') continue;
    if (columns.empty())
      columns = read_header(line, units, {path, number});
    else
      rows.push_back(read_row(line, columns, {path, number}));
  }
  if (rows.empty()) throw InputError(path.string() + ": holds no measurements");
  return rows;
}

}  // namespace windlass::measurement
