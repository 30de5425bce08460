#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "windlass/measurement/friction_fit.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::measurement {

/// Draws the measured strengths over mu R_tot(T) of the run's stable states, and their ratio below; in newtons and grams
/// for a physical scene. Script and data (`fit.gp`, `fit*.dat`) lie beside the pictures.
/// @param left_out  points that did not take part
/// @return the pictures written
/// @throws output::OutputError when the folder cannot be written, or gnuplot is missing or fails
std::vector<std::filesystem::path> draw_fit(const output::Run& run, const FrictionFit& fit,
                                            std::span<const ComparedPoint> points,
                                            std::span<const ComparedPoint> left_out,
                                            const std::optional<scene::Units>& units,
                                            const std::filesystem::path& folder,
                                            const std::vector<std::string>& formats);

}  // namespace windlass::measurement
