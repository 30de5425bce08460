#include "windlass/output/branches_csv.hpp"

#include <charconv>
#include <cmath>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/error.hpp"

namespace windlass::output {

namespace {

/// Reads the cells of one line in order; errors name the file, the line and the cell.
class CellReader {
 public:
  CellReader(const std::filesystem::path& path, std::size_t line, std::vector<std::string> cells)
      : path_(path), line_(line), cells_(std::move(cells)) {}

  std::string text() { return next(); }
  /// An empty cell is a number that does not exist: NaN.
  double real() {
    const std::string cell = next();
    return cell.empty() ? std::nan("") : parse<double>(cell);
  }
  int integer() { return parse<int>(next()); }
  template <class T>
  std::optional<T> optional() {
    const std::string cell = next();
    return cell.empty() ? std::nullopt : std::optional<T>(parse<T>(cell));
  }
  void expect_end() const {
    if (next_ != cells_.size())
      fail("has " + std::to_string(cells_.size()) + " cells instead of " + std::to_string(next_));
  }

 private:
  std::string next() {
    if (next_ >= cells_.size()) fail("has too few cells");
    return cells_[next_++];
  }
  template <class T>
  T parse(const std::string& cell) const {
    T value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
      fail("holds \"" + cell + "\" where a number belongs");
    return value;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw OutputError(path_.string() + ": line " + std::to_string(line_) + " " + what);
  }

  const std::filesystem::path& path_;
  std::size_t line_;
  std::vector<std::string> cells_;
  std::size_t next_ = 0;
};

BranchRow read_row(CellReader cells, bool has_cylinder, bool has_extra) {
  BranchRow row;
  row.branch = cells.integer();
  row.point = cells.integer();
  row.label = cells.text();
  row.type = cells.text();
  row.T = cells.real();
  row.phi = cells.real();
  if (has_cylinder) {
    row.R_tot = cells.real();
    row.phi_star = cells.real();
  } else {
    row.end_force = cells.real();
    row.end_moment = cells.real();
    row.shortening = cells.real();
  }
  row.tilt = cells.real();
  row.z_span = cells.real();
  row.energy = cells.real();
  row.self_distance = cells.optional<double>();
  row.self_force = cells.real();
  if (has_cylinder) {
    row.plate_force = cells.real();
    row.F0 = cells.optional<double>();
    row.travel = cells.optional<double>();
  }
  row.index = cells.optional<int>();
  row.eigenvalue_1 = cells.optional<double>();
  row.ds = cells.real();
  row.newton_iterations = cells.integer();
  row.error_estimate = cells.real();
  row.topology = cells.text();
  if (has_extra) row.parameter = cells.optional<double>();
  cells.expect_end();
  return row;
}

}  // namespace

std::vector<std::string> split_csv(std::string_view line) {
  std::vector<std::string> cells(1);
  bool inside_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (inside_quotes && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += '"';
      ++i;
    } else if (c == '"') {
      inside_quotes = !inside_quotes;
    } else if (c == ',' && !inside_quotes) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string format_number(double value) {
  if (!std::isfinite(value)) return {};
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string csv_header(bool has_cylinder, const std::string& extra_parameter) {
  std::string header = "branch,point,label,type,T,phi,";
  header += has_cylinder ? "R_tot,phi_star," : "end_force,end_moment,shortening,";
  header += "tilt,z_span,energy,self_distance,self_force,";
  if (has_cylinder) header += "plate_force,F0,travel,";
  header += "index,eigenvalue_1,ds,newton_iterations,error_estimate,topology";
  if (!extra_parameter.empty()) header += "," + csv_cell(extra_parameter);
  return header + "\n";
}

std::string csv_line(const BranchRow& row, bool has_cylinder, const std::string& extra_parameter) {
  std::string line = std::to_string(row.branch) + "," + std::to_string(row.point) + "," +
                     csv_cell(row.label) + "," + csv_cell(row.type);
  const auto add = [&line](double value) { line += "," + format_number(value); };
  add(row.T);
  add(row.phi);
  if (has_cylinder) {
    add(row.R_tot);
    add(row.phi_star);
  } else {
    add(row.end_force);
    add(row.end_moment);
    add(row.shortening);
  }
  add(row.tilt);
  add(row.z_span);
  add(row.energy);
  add(row.self_distance.value_or(std::nan("")));
  add(row.self_force);
  if (has_cylinder) {
    add(row.plate_force);
    add(row.F0.value_or(std::nan("")));
    add(row.travel.value_or(std::nan("")));
  }
  line += "," + (row.index ? std::to_string(*row.index) : std::string());
  add(row.eigenvalue_1.value_or(std::nan("")));
  add(row.ds);
  line += "," + std::to_string(row.newton_iterations);
  add(row.error_estimate);
  line += "," + csv_cell(row.topology);
  if (!extra_parameter.empty()) add(row.parameter.value_or(std::nan("")));
  return line + "\n";
}

std::vector<BranchRow> read_branches(const std::filesystem::path& path, bool has_cylinder,
                                     const std::string& extra_parameter) {
  const std::string content = read_file(path);
  const std::string header = csv_header(has_cylinder, extra_parameter);
  if (!content.starts_with(header))
    throw OutputError(path.string() + ": the first line is not the expected header");
  std::vector<BranchRow> rows;
  std::size_t line = 2;
  for (std::size_t begin = header.size(); begin < content.size(); ++line) {
    const std::size_t end = content.find('\n', begin);
    if (end == std::string::npos) break;  // cut by a kill
    const std::string_view text(content.data() + begin, end - begin);
    rows.push_back(read_row(CellReader(path, line, split_csv(text)), has_cylinder, !extra_parameter.empty()));
    begin = end + 1;
  }
  return rows;
}

}  // namespace windlass::output
