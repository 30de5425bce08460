#pragma once

#include <array>
#include <string>
#include <vector>

#include "thick_runs.hpp"

/// The runs that the figures of the clove hitch and of the thin limit are drawn from.
namespace windlass::figures {

/// In the radius of the rod, at T = 2 and 1.2.
inline constexpr std::array<const char*, 2> thin_limit_runs = {"thin-limit-2", "thin-limit-1.2"};

/// From T = 1 down, and up to where the contacts can no longer be followed.
std::string clove_hitch_down_run(const Thickness& thickness);
std::string clove_hitch_up_run(const Thickness& thickness);

std::vector<PlannedRun> knot_runs();

/// The hitch on a plate, while a cylinder slides through it.
std::string sliding_hitch_run(const Thickness& thickness);
std::vector<PlannedRun> sliding_hitch_runs();

/// R/r = 2.5, of the paper's simulations of the knot.
inline constexpr const Thickness& simulated = thicknesses[2];
static_assert(simulated.ratio == 2.5);

}  // namespace windlass::figures
