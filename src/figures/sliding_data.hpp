#pragma once

#include <optional>
#include <string>
#include <vector>

#include "style.hpp"
#include "windlass/figures/figure.hpp"
#include "windlass/pull/pull.hpp"

/// What the figure of the sliding strength on a plate is drawn from: μ = 0.32, a thin rod, its travel blocked.
namespace windlass::figures {

/// Names in the study: the flat coil on its plate in the plane, and in space as far as its line goes.
std::string on_plate_run(const Angle& angle);
std::string in_space_run(const Angle& angle);
/// States of one turn that have left the plate.
inline constexpr const char* dragged_run = "plate-2pi-dragged";
inline constexpr const Angle& pulled = angles[1];

std::vector<PlannedRun> sliding_runs();

/// F0/μ of a row [EI/ρ²].
double strength_of(const output::BranchRow& row, const StudyRun& study);

/// F0/μ of a run, sliding-RUN.dat: columns T, F0/μ; block 0 stable, 1 unstable.
void write_strengths(const std::string& run, const StudyRun& study, const Canvas& canvas);

/// One turn pulled from rest, on one mesh.
struct PullCurve {
  double tension;                   ///< [EI/ρ²]
  bool dragged;                     ///< does the steady state beside it stand off the plate?
  double steady;                    ///< F0/μ of that state [EI/ρ²]
  std::optional<pull::Plateau> at;  ///< empty: no plateau was reached
  std::vector<pull::Row> rows;
};

/// Compared with the state that has left the plate where that exists, with the flat coil elsewhere.
std::vector<PullCurve> pull_curves(const Study& study);

/// Columns U, F/μ; a block a pull.
inline constexpr const char* pull_file = "sliding-pull.dat";
void write_pulls(const std::vector<PullCurve>& curves, double friction, const Canvas& canvas);

/// What `solve` finds at an angle and a tension, beside the flat coil.
struct Search {
  Angle angle;
  double tension;       ///< [EI/ρ²]
  std::size_t dragged;  ///< states that have left the plate
};
std::vector<Search> searches(const Study& study);

}  // namespace windlass::figures
