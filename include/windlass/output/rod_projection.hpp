#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "windlass/output/rod_curve.hpp"

/// Parallel projection of a rod and its cylinder with the parts hidden by the cylinder told apart: gnuplot
/// draws lines and surfaces in 3D without telling which is in front.
namespace windlass::output {

/// Looking from direction `towards` (from the scene to the eye); right and up span the picture.
struct View {
  Eigen::Vector3d towards, right, up;

  /// @param azimuth,elevation  of the eye, radians; azimuth 0 is e_x, elevation 0 the plane z = 0
  static View from(double azimuth, double elevation) {
    View view;
    view.towards << std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
        std::sin(elevation);
    view.right << -std::sin(azimuth), std::cos(azimuth), 0.0;
    view.up = view.towards.cross(view.right);
    return view;
  }
  /// Down the axis of the cylinder: x to the right, y up.
  static View along_axis() {
    return {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  }
  Eigen::Vector2d project(const Eigen::Vector3d& r) const { return {right.dot(r), up.dot(r)}; }
};

/// The finite piece of the cylinder that is drawn.
struct Drum {
  double radius = 1.0, low = -1.0, high = 1.0;

  /// True when the drum stands between r and the eye.
  bool hides(const Eigen::Vector3d& r, const View& view) const;
  /// True when a place outside the drum is farther from the eye than the axis beside it: to be drawn before
  /// the drum.
  bool covers(const Eigen::Vector3d& r, const View& view) const {
    return view.towards.head<2>().dot(r.head<2>()) < 0.0 && r.z() > low && r.z() < high;
  }
  /// Closed outline of the piece in the picture, and the rim that faces the eye.
  std::vector<Eigen::Vector2d> outline(const View& view) const;
  std::vector<Eigen::Vector2d> rim(const View& view, double z) const;
};

/// Height of the rod near the cylinder, with room to see its ends.
/// @param rod_radius  [ρ]; the cylinder is that much slimmer than the one on which the centre line lies
Drum drum_for(const RodCurve& curve, double rod_radius);

}  // namespace windlass::output
