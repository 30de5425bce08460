#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/output/rod_projection.hpp"
#include "windlass/output/tube_view.hpp"
#include "windlass/scene/scene.hpp"

/// The rod round its cylinder as pictures: data and gnuplot commands of a view.
namespace windlass::output {

/// What is drawn in every view of one rod.
struct RodScene {
  const RodCurve& curve;
  const equilibrium::Solution& solution;
  const std::vector<PointForce>& forces;
  Drum drum;
  double arrow;             ///< length of an arrow over its force [ρ³/EI]
  double highest_pressure;  ///< [EI/ρ³]
  Stroke stroke;            ///< without a radius: a line
  std::vector<scene::Plate> plates;

  bool is_thick() const { return stroke.radius > 0.0; }
};

/// Blocks of one view: 0 visible rod and 1 hidden rod (right, up), 2 visible line contact (right, up, p), 3
/// point forces (right, up, the arrow, and its colour), 4 outline of the cylinder, 5 its near rim, 6 places
/// where strands touch, 7 with a plate: its edge, or a circle on it. Of a thick rod 0 and 2 are polygons (right, up, colour): what is before the cylinder,
/// and what is not.
///
/// gnuplot numbers blocks by the data they hold, so that an empty one still gets a line of missing values.
std::string view_data(const RodScene& scene, const View& view);

/// Part of the picture plane that is shown.
struct Frame {
  double left = 0.0, right = 0.0, low = 0.0, high = 0.0;
};

/// From the side, and a little from above: where strands touch, or else where the rod's middle lies.
View side_view(const RodScene& scene);

/// Holds cylinder, forces and the rod near them, and has the given width/height.
Frame frame_of(const RodScene& scene, const View& view, double aspect);

std::string view_commands(const RodScene& scene, const std::string& file, bool with_rim, const Frame& frame);

}  // namespace windlass::output
