#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "windlass/output/records.hpp"

namespace windlass::output {

/// Header line of branches.csv, with the columns of CONTRACT; struts have end_force, end_moment, shortening
/// where capstans have R_tot, phi_star. `extra_parameter` (when not empty) names a last column.
std::string csv_header(bool has_cylinder, const std::string& extra_parameter);

/// One line, numbers in shortest form that reads back exactly; a number that is not finite is an empty cell.
std::string csv_line(const BranchRow& row, bool has_cylinder, const std::string& extra_parameter);

/// Rows of a file. A last line without its newline was cut by a kill and is left out.
/// @throws OutputError naming file and line when a cell cannot be read
std::vector<BranchRow> read_branches(const std::filesystem::path& path, bool has_cylinder,
                                     const std::string& extra_parameter);

/// Cells of one line, without their quotes (RFC 4180).
std::vector<std::string> split_csv(std::string_view line);

/// Text as a cell: quoted only where it must be (RFC 4180).
std::string csv_cell(const std::string& text);

/// Shortest decimal form that reads back exactly; empty when the value is not finite.
std::string format_number(double value);

}  // namespace windlass::output
