#pragma once

#include <string>
#include <vector>

#include "thick_runs.hpp"
#include "windlass/figures/figure.hpp"

/// Two turns at the paper's ratios of radii, as the figures of its appendices draw them.
namespace windlass::figures {

struct Drawn {
  Thickness thickness;
  std::vector<TwoTurns> states;
};

/// The ratios of the paper, with their states.
std::vector<Drawn> drawn(const Study& study);

/// Largest force at a tension over the smallest of all thicknesses, less 1; negative where one of them is not known.
double spread(const std::vector<Drawn>& list, double tension);

/// Data of one of them: columns T, R_tot, wrapping angle/π, angle along lines/π.
std::string file_of(const Thickness& thickness);
void write_states(const std::vector<Drawn>& list, const Canvas& canvas);

/// Further items of a plot command, from columns of their files: narrower and narrower, since they lie on each
/// other.
std::string curves(const std::vector<Drawn>& list, const std::string& columns, bool titles);

/// Names of the runs.
std::vector<std::string> runs(const std::vector<Drawn>& list);

}  // namespace windlass::figures
