#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

/// Plain columnar tables and their HDF5 form, without any knowledge of rods.
namespace windlass::output {

/// One named quantity of a table: a view of values kept elsewhere, row-major, `width` consecutive numbers a row.
struct Column {
  using Reals = std::vector<double>;
  using Integers = std::vector<std::int64_t>;
  using Texts = std::vector<std::string>;

  std::string name;
  std::string units;    ///< "1" for pure numbers; empty for text
  std::string meaning;  ///< one line
  std::variant<Reals*, Integers*, Texts*> values;
  int width = 1;  ///< 1, 3 (vector) or 4 (quaternion); text always 1

  std::size_t rows() const;
};

struct Table {
  std::string name;
  std::string meaning;
  std::vector<Column> columns;
};

/// Writes every table as a group and every column as a dataset with attributes `units`, `shape`, `meaning`.
///
/// The HDF5 image is built in memory and put in place by replace_file: HDF5 itself never writes to disk, so
/// neither a kill nor a full disk can leave a half-written file or a confused library. A checksum follows the image,
/// beyond what HDF5 reads.
/// @throws OutputError when the file cannot be written
void write_tables(const std::filesystem::path& path, const std::vector<Table>& tables,
                  const std::string& about);

/// Fills the vectors that the columns of `tables` view from the file.
/// @throws OutputError naming the file when it is unreadable, truncated, damaged, or lacks a column
void read_tables(const std::filesystem::path& path, const std::vector<Table>& tables);

}  // namespace windlass::output
