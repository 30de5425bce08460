#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "windlass/obstacle/surface.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::output {

struct PlotOptions {
  std::vector<std::string> formats = {"png", "svg", "pdf"};
  std::vector<std::string>
      points;  ///< rods to draw, by label or BRANCH-POINT; empty: special points and branch ends
  std::size_t most_rods = 12;                       ///< of the automatic choice
  std::optional<scene::Units> units;                ///< adds axes in newtons and grams to the diagram
  obstacle::Set obstacles;                          ///< drawn beside struts
  double rod_radius = 0.0;                          ///< [ρ]; 0: rods are drawn as lines
  std::vector<scene::Plate> plates;                 ///< drawn in side views of rods round a cylinder
  std::vector<std::pair<double, double>> measured;  ///< dimensionless (T, R_tot) laid over the diagram
  std::filesystem::path folder;                     ///< where pictures go; empty: RUN/plots
};

/// Draws the bifurcation diagram and rod shapes of a run with gnuplot.
///
/// Every picture NAME.{png,svg,pdf} lies beside its script NAME.gp and data NAME*.dat, so that `gnuplot NAME.gp` in
/// that folder makes it again after restyling. Pictures: `diagram` (R_tot, alpha = dlog R_tot/dlog T, phi_star and a
/// fourth quantity against T or phi; struts: end_force against shortening) and `rod-POINT` (the rod round its
/// cylinder from the side of the axis and in perspective, pressure in colour, point forces as arrows, p along s).
///
/// @return the pictures written
/// @throws OutputError when the run cannot be read, a point is unknown, gnuplot is missing or fails
std::vector<std::filesystem::path> plot_run(const std::filesystem::path& run,
                                            const PlotOptions& options = {});

/// The diagram alone; base of the file names is `stem`.
std::vector<std::filesystem::path> plot_diagram(const Run& run, const PlotOptions& options,
                                                const std::filesystem::path& folder, const std::string& stem);
/// One rod; base of the file names is `stem`.
std::vector<std::filesystem::path> plot_rod(const equilibrium::Solution& solution, const std::string& title,
                                            const PlotOptions& options, const std::filesystem::path& folder,
                                            const std::string& stem);

/// alpha = dlog R_tot/dlog T at every row of one branch, in order; NaN at folds in T and where it is undefined.
/// Second-order differences along the branch that do not reach across a change of topology, where R_tot has a kink.
std::vector<double> log_slopes(const std::vector<BranchRow>& rows);

}  // namespace windlass::output
