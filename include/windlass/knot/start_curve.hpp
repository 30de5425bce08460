#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "windlass/scene/scene.hpp"

/// Curves that knots start on, before they are relaxed.
namespace windlass::knot {

/// Corners of a curve, the half s >= 0 from the mid-point on; its half-turn image about e_y is the other half.
using Curve = std::vector<Eigen::Vector3d>;

/// The clove hitch round the unit cylinder (PHYSICS, "The clove hitch"): the middle strand passes the south pole over both
/// tails, each half makes a full turn round the cylinder, passes under the middle strand, and leaves along ±e_x.
/// @param radius  r of the rod, whose strands clear each other [ρ]
Curve clove_hitch(double radius);

/// What a curve in a file must keep to, in the unit of its points.
struct Bounds {
  double radius = 0.0;   ///< of the rod
  double length = 0.0;   ///< of the rod: the curve must not be longer
  bool cylinder = true;  ///< of radius 1 − radius, which it must not pass through
};

/// The points x, y, z of a whole curve in a CSV file, from end to end [ρ; without a cylinder as rod.length is given]; of its half
/// from the mid-point on what is read.
/// @throws InputError naming file, line and column, or what is wrong with the curve: too few points, not its own half-turn image,
///         nearer to itself than r, through the cylinder
Curve read_curve(const std::filesystem::path& path, const Bounds& bounds);

/// The curve of a scene that is tied, in the units it is solved in.
Curve start_curve(const scene::Scene& scene);

}  // namespace windlass::knot
