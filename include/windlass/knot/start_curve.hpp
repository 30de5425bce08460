#pragma once

#include <Eigen/Core>
#include <vector>

/// Curves that knots start on, before they are relaxed.
namespace windlass::knot {

/// Corners of a curve, the half s >= 0 from the mid-point on; its half-turn image about e_y is the other half.
using Curve = std::vector<Eigen::Vector3d>;

/// The clove hitch round the unit cylinder (PHYSICS, "The clove hitch"): the middle strand passes the south pole over both
/// tails, each half makes a full turn round the cylinder, passes under the middle strand, and leaves along ±e_x.
/// @param radius  r of the rod, whose strands clear each other [ρ]
Curve clove_hitch(double radius);

}  // namespace windlass::knot
