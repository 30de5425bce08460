#include "app/sweep_folder.hpp"

#include <fmt/format.h>

#include <sstream>

#include "app/sweep_case.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace fs = std::filesystem;

fs::path SweepFolder::row_file(int number) const { return run_folder(number).string() + ".csv"; }

fs::path SweepFolder::run_folder(int number) const {
  return folder_ / "cases" / fmt::format("{:06}", number + 1);
}

void SweepFolder::prepare(const std::string& description, bool force, bool resume) const {
  const fs::path plan = folder_ / "sweep.json";
  if (resume && fs::exists(plan)) {
    if (output::read_file(plan) != description)
      throw InputError("--resume: " + folder_.string() +
                       " holds a sweep of another scene, other values or another version; use --force to "
                       "replace it or --out to write elsewhere");
    return;
  }
  if (fs::exists(folder_) && !fs::is_empty(folder_) && !force)
    throw InputError(resume
                         ? "--resume: " + folder_.string() + " holds no sweep"
                         : folder_.string() + ": is not empty; --force replaces a sweep, --resume goes on");
  for (const char* old : {"sweep.json", "sweep.csv", "branches.csv", "cases"}) fs::remove_all(folder_ / old);
  fs::create_directories(folder_ / "cases");
  output::replace_file(plan, std::string_view(description));
}

int SweepFolder::count() const {
  int found = 0;
  for (int k = 0; k < grid_.size(); ++k) found += has(k);
  return found;
}

int SweepFolder::merge(const std::string& header) const {
  std::string table = header;
  int failed = 0;
  for (int k = 0; k < grid_.size(); ++k) {
    if (!has(k)) continue;
    const std::string row = output::read_file(row_file(k));
    failed += SweepCase::failed(row);
    table += row;
  }
  output::replace_file(folder_ / "sweep.csv", std::string_view(table));
  merge_branches();
  return failed;
}

void SweepFolder::merge_branches() const {
  std::string table;
  for (int k = 0; k < grid_.size(); ++k) {
    const fs::path branches = run_folder(k) / "branches.csv";
    if (!has(k) || !fs::exists(branches)) continue;
    std::string prefix = std::to_string(k + 1) + ",", names = "case,";
    for (const std::string& value : grid_.values(k)) prefix += output::csv_cell(value) + ",";
    for (const SweepAxis& axis : grid_.axes()) names += axis.key + ",";
    std::istringstream lines(output::read_file(branches));
    std::string line;
    std::getline(lines, line);
    if (table.empty()) table = names + line + "\n";
    while (std::getline(lines, line)) table += prefix + line + "\n";
  }
  if (!table.empty()) output::replace_file(folder_ / "branches.csv", std::string_view(table));
}

}  // namespace windlass::app
