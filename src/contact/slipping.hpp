#pragma once

#include "windlass/contact/joint.hpp"

/// Balance at the contacts of a cylinder that slips along the rod.
namespace windlass::contact::spatial {

/// Derivatives of a direction along the chart's tangents with a joint's degrees of freedom.
using SlipSlope = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_coordinates>;

/// Displacements along the surface, turned so that the force N + mu d of a cylinder that slips does no work on them.
/// @param d  components of the direction of slip along the chart's tangents
SmallMatrix slipping(const SmallMatrix& along, const obstacle::Chart& here, double friction,
                     const Eigen::Vector2d& d);

/// Derivatives of those displacements' work on a force f, of rows k and columns l: −mu [∂d_k/∂w_l N + d_k ∂N/∂w_l]·f.
void add_slipping(const obstacle::Chart& here, double friction, const Eigen::Vector2d& d,
                  const SlipSlope& by_w, const SmallVector& f, SmallMatrix& out);

/// Direction of slip at a touch, d = (e_z − ω t)/|e_z − ω t|, and its derivatives, along the chart's tangents.
struct TouchSlip {
  Eigen::Vector2d d;
  SlipSlope by_w;
  Eigen::Vector3d direction;       ///< d in the world
  Eigen::Matrix3d direction_by_v;  ///< with the frame's increments
};
TouchSlip slip_at(const obstacle::Chart& here, const Eigen::Matrix3d& directors, double travel);

/// Friction that acts at the rod's surface, `arm` from the centre line: its moment −arm mu f N × d does work on turns φ of
/// the section. In the columns of `tested` that turn the touch (the last three, half the angle in the body frame) that is
/// arm mu (N × d)·φ times N.
void add_couple(const obstacle::Chart& here, double friction, double arm, const Eigen::Matrix3d& directors,
                const TouchSlip& slip, SmallMatrix& tested);

/// Derivatives of those columns' work on a force f.
void add_couple_slope(const obstacle::Chart& here, double friction, double arm,
                      const Eigen::Matrix3d& directors, const TouchSlip& slip, const SmallVector& f,
                      SmallMatrix& out);

}  // namespace windlass::contact::spatial
