#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/commands.hpp"
#include "app/sweep_grid.hpp"

namespace windlass::app {

/// Does one case of a sweep, on whichever rank: its row depends on nothing but the case.
class SweepCase {
 public:
  /// @param has_cylinder  of the scenes, which decides what is measured
  SweepCase(const SweepRequest& request, const SweepGrid& grid, bool has_cylinder)
      : request_(request), grid_(grid), has_cylinder_(has_cylinder) {}

  /// Header of the table of rows.
  std::string header() const;
  /// @param number  from 0
  /// @param folder  where a branch's run goes; there is none for `solve`
  /// @return the row; nullopt if the user interrupted it
  std::optional<std::string> run(int number, const std::filesystem::path& folder) const;
  /// Did the case come to an answer? Reads the row.
  static bool failed(const std::string& row);

 private:
  std::string solve(const scene::Scene& scene) const;
  std::optional<std::string> walk(const scene::Scene& scene, const std::filesystem::path& folder) const;
  std::string columns() const;

  const SweepRequest& request_;
  const SweepGrid& grid_;
  bool has_cylinder_;
};

}  // namespace windlass::app
