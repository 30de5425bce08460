#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <vector>

#include "windlass/scene/scene.hpp"

namespace windlass::verify {

/// What the rod may touch, by its own formulas: the unit cylinder, √(x² + y²) − 1, a plane wall, distance − n·r, or a plate with an
/// outer edge: the points that are no nearer than the rod's radius to the body that the plate is the foot of.
class Shape {
 public:
  static Shape cylinder() { return {}; }
  static Shape of(const scene::Wall& wall);
  /// @param rod_radius  r, of the rod whose centre line `plate.height` is for
  static Shape of(const scene::Plate& plate, double rod_radius);
  /// The cylinder slipping towards +e_z along a rod that runs along itself at `travel` times its speed.
  /// @param arm  from the rod's centre line to where its friction acts; 0: without moment about it
  static Shape slipping(double friction, double travel, double arm);
  /// The same where a plate takes what the friction has along e_z, but for what holds a rod of this curvature, twisted by the
  /// moment of that friction, in the plate: n_z = M κ.
  Shape beside_plate(double curvature = 1.0) const;

  double gap(const Eigen::Vector3d& r) const;
  /// Normal part of the contact force on a rod with the tangent t, of size 1. Only a sharp edge asks for t: normal to it.
  Eigen::Vector3d outward(const Eigen::Vector3d& r, const Eigen::Vector3d& t) const;
  /// Its whole contact force, N + mu d, on a rod with the tangent t, or where it stretches with the slope r' = λ t.
  Eigen::Vector3d push(const Eigen::Vector3d& r, const Eigen::Vector3d& t) const;
  /// The moment of push() about the centre line, per force: it acts `arm` below it.
  Eigen::Vector3d couple(const Eigen::Vector3d& r, const Eigen::Vector3d& t) const {
    return -arm_ * outward(r, t).cross(outward(r, t) + drag(t));
  }
  /// mu d·t of a rod with the slope r' = λ t: what friction has along it, per force along the normal.
  double along(const Eigen::Vector3d& r, const Eigen::Vector3d& slope) const {
    return (push(r, slope) - outward(r, slope)).dot(slope.normalized());
  }
  double arm() const { return arm_; }
  bool has_edge() const { return std::isfinite(outer_radius_); }
  /// The same plate without an end.
  Shape without_edge() const {
    Shape shape = *this;
    shape.outer_radius_ = HUGE_VAL;
    return shape;
  }
  /// Is a place beyond a plate's outer edge? On it, to the precision of an event, it is not.
  bool past_edge(const Eigen::Vector3d& r) const {
    constexpr double located = 1e-9;
    return r.head<2>().norm() > outer_radius_ + located;
  }
  bool has_couple() const { return arm_ > 0.0; }
  bool drags() const { return friction_ > 0.0; }
  /// Does it drag, and nothing take what is along the axis on the spot?
  bool drags_alone() const { return drags() && !left_by_plate_; }
  /// Second derivative of the gap along a unit tangent t, but for the part that the curvature of the rod has.
  double bend(const Eigen::Vector3d& r, const Eigen::Vector3d& t) const;
  /// The outward normal of a wall, the same everywhere.
  const std::optional<Eigen::Vector3d>& wall() const { return normal_; }

 private:
  std::optional<Eigen::Vector3d> normal_;  ///< of a wall: −n
  double distance_ = 0.0;
  double friction_ = 0.0, travel_ = 0.0, arm_ = 0.0;
  /// Of a place: outward from the physical edge, and from the plate's physical plane.
  Eigen::Vector2d beside(const Eigen::Vector3d& r) const;
  double outer_radius_ = HUGE_VAL, rod_radius_ = 0.0;
  Eigen::Vector3d drag(const Eigen::Vector3d& t) const;  ///< mu d
  std::optional<double> left_by_plate_;                  ///< share of the friction along e_z
};

/// All shapes of a scene, in the order that contacts name them by.
/// @param travel  of the rod along itself, over the speed of a cylinder that slips along it
std::vector<Shape> shapes_of(const scene::Scene& scene, double travel);

}  // namespace windlass::verify
