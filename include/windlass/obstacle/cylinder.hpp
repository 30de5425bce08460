#pragma once

#include "windlass/obstacle/surface.hpp"

namespace windlass::obstacle {

/// The unit cylinder about e_z, the rod outside:
///
///     gap = √(x² + y²) − 1,   X(a, z) = (sin a, −cos a, z),   N(a) = (sin a, −cos a, 0),
///
/// a = 0 at the south pole (0, −1, 0).
class Cylinder final : public Surface {
 public:
  double gap(const Vector3d& r) const override;
  Vector3d normal(const Vector3d& r) const override;
  Matrix3d hessian(const Vector3d& r) const override;
  Chart chart(const Vector2d& u) const override;
  Vector3d rise(const Vector2d& u, const Vector2d& step) const override;
  LongVector3 place(const LongVector2& u) const override;
  Vector2d coordinates(const Vector3d& r, double turn) const override;
  double turn(const Vector2d& u) const override { return u(0); }
  Quaternion base_frame(const Vector2d& u) const override;
  double curvature() const override { return 1.0; }
  bool slips() const override { return true; }
  bool keeps_flat() const override { return true; }
  bool endless_along_x() const override { return false; }

  static Vector3d outward(double a);       ///< N
  static Vector3d around(double a);        ///< ∂X/∂a
  static double angle(const Vector3d& r);  ///< a, to whole turns
};

/// The one cylinder there is.
const SurfacePointer& unit_cylinder();

}  // namespace windlass::obstacle
