#pragma once

#include "plot_diagram_data.hpp"

namespace windlass::output {

/// The piece with further rows between its points, on a cubic through them (pchip: monotone between two points) in
/// the chord length of the diagram as drawn: steps are as long as the corrector allows, which shows as corners. Rows beside
/// values that do not exist have none either.
/// @param axes  x, then one a panel; their ranges are known
Piece smooth(const Piece& piece, const std::vector<const Axis*>& axes);

}  // namespace windlass::output
