#pragma once

#include <filesystem>
#include <string>

#include "app/sweep_grid.hpp"

namespace windlass::app {

/// Where a sweep lives on disk: sweep.json says what is swept; cases/NNNNNN.csv is the row of a finished case, a file
/// each, so that ranks never write to the same one; cases/NNNNNN holds a branch's run; sweep.csv and branches.csv are
/// put together at the end.
class SweepFolder {
 public:
  SweepFolder(std::filesystem::path folder, const SweepGrid& grid)
      : folder_(std::move(folder)), grid_(grid) {}

  /// Makes the folder, or with `resume` checks that it holds this sweep.
  /// @param description  all that decides what the sweep will hold
  /// @throws InputError for a folder in use or another sweep's; output::OutputError
  void prepare(const std::string& description, bool force, bool resume) const;

  std::filesystem::path row_file(int number) const;
  std::filesystem::path run_folder(int number) const;
  bool has(int number) const { return std::filesystem::exists(row_file(number)); }
  /// Number of cases finished.
  int count() const;
  /// Writes sweep.csv and, where there are runs, branches.csv: every point of every branch, its case in front.
  /// @return number of cases that failed
  int merge(const std::string& header) const;
  const std::filesystem::path& path() const { return folder_; }

 private:
  void merge_branches() const;

  std::filesystem::path folder_;
  const SweepGrid& grid_;
};

}  // namespace windlass::app
