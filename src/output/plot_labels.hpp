#pragma once

#include <string>

#include "plot_diagram_data.hpp"

namespace windlass::output {

/// Commands that name the special points in the first panel, each on the side where its name covers least of the curves;
/// a name that would cover an earlier one is left out (its marker stays, and special_points.json lists it).
std::string label_commands(const DiagramData& data);

}  // namespace windlass::output
