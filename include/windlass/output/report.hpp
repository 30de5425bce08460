#pragma once

#include <nlohmann/json.hpp>

#include "windlass/output/run_folder.hpp"

namespace windlass::output {

struct ReportOptions {
  std::optional<scene::Units> units;  ///< adds newtons and grams to the quantities on offer
  std::size_t most_rods = 600;        ///< rods stored in the page; of longer runs every k-th ordinary point
  std::filesystem::path file;         ///< empty: RUN/report.html
};

/// Writes one self-contained HTML file (works offline, from a file:// address): the bifurcation diagram of any two
/// recorded quantities with stable and unstable arms, special points and a filter by branch; beside it, for the point
/// clicked or under the cursor, the rod in 3D round its cylinder with the pressure in colour and point forces as
/// arrows, the pressure along s, the eigenvalues, and the lowest mode laid over the rod.
/// @return the file written
/// @throws OutputError when the run cannot be read, the file not written, or the program was built without Plotly
std::filesystem::path write_report(const std::filesystem::path& run, const ReportOptions& options = {});

/// What the page shows, as page.js expects it.
nlohmann::ordered_json report_data(const Run& run, const ReportOptions& options);

}  // namespace windlass::output
