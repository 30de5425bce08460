#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "windlass/obstacle/surface.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::output {

struct ReportOptions {
  obstacle::Set obstacles;            ///< drawn beside struts
  std::vector<scene::Plate> plates;   ///< drawn round the cylinder
  std::optional<scene::Units> units;  ///< adds newtons and grams to the quantities on offer
  double rod_radius = 0.0;            ///< [ρ]; 0: rods are drawn as lines
  std::size_t most_rods = 600;        ///< rods stored in the page; of longer runs every k-th ordinary point
  std::filesystem::path file;         ///< empty: RUN/report.html
  /// Called with each rod of the page and its place in the store, to add what the run does not hold (modes).
  std::function<void(std::size_t position, equilibrium::Solution& solution)> complete;
};

/// Writes one self-contained HTML file (works offline, from a file:// address): the bifurcation diagram of any two
/// recorded quantities with stable and unstable arms, special points and a filter by branch; beside it, for the point
/// clicked or under the cursor, the rod in 3D round its cylinder with the pressure in colour and point forces as
/// arrows, the pressure along s, the eigenvalues, and the lowest mode laid over the rod.
/// @return the file written
/// @throws OutputError when the run holds no points, the file cannot be written, or the program was built without Plotly
std::filesystem::path write_report(const Run& run, const ReportOptions& options = {});

/// What the page shows, as page.js expects it.
nlohmann::ordered_json report_data(const Run& run, const ReportOptions& options);

}  // namespace windlass::output
