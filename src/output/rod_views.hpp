#pragma once

#include <string>
#include <vector>

#include "rod_projection.hpp"
#include "windlass/equilibrium/solution.hpp"

/// The rod round its cylinder as pictures: data and gnuplot commands of a view.
namespace windlass::output {

/// What is drawn in every view of one rod.
struct RodScene {
  const RodCurve& curve;
  const equilibrium::Solution& solution;
  const std::vector<PointForce>& forces;
  Drum drum;
  double arrow;  ///< length of an arrow over its force [ρ³/EI]
};

/// Blocks of one view: 0 visible rod and 1 hidden rod (right, up), 2 visible line contact (right, up, p), 3 point
/// forces (right, up, and the arrow), 4 outline of the cylinder, 5 its near rim.
///
/// gnuplot numbers blocks by the data they hold, so that an empty one still gets a line of missing values.
std::string view_data(const RodScene& scene, const View& view);

/// Part of the picture plane that is shown.
struct Frame {
  double left = 0.0, right = 0.0, low = 0.0, high = 0.0;
};

/// Holds cylinder, forces and the rod near them, and has the given width/height.
Frame frame_of(const RodScene& scene, const View& view, double aspect);

std::string view_commands(const std::string& file, bool with_rim, const Frame& frame);

}  // namespace windlass::output
