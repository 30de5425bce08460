#pragma once

#include <cmath>

#include "windlass/contact/joint.hpp"
#include "windlass/obstacle/cylinder.hpp"

/// Joints of the planar elastica round the unit circle.
///
/// Configuration θ; position (x, y) on free arcs, the angle a on a line contact. Contacts lie on the section z = 0 of
/// obstacle::Cylinder.
namespace windlass::contact::planar {

/// Adds vector-space retraction to joints without rotations.
class VectorJoint : public Joint {
 public:
  int ambient() const override { return tangent(); }
  void retract(const double* w, const double* dw, double* out) const override {
    for (int i = 0; i < tangent(); ++i) out[i] = w[i] + dw[i];
  }
};

/// Isolated touch: w = (a, θ), arclength unknown.
/// Equations 3: tangential force balance, moment continuity, tangency sin(a − θ) = 0. Force by the normal balance.
class Touch final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 2; }
  bool locates() const override { return true; }
  int places() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  const obstacle::Surface* surface() const override { return obstacle::unit_cylinder().get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], 0.0}; }
  double slide(const double* w) const override { return std::cos(w[0] - w[1]); }
  void adopt(const Place& place, double* w) const override { w[0] = place.angle, w[1] = place.heading; }
};

/// End of a line contact: w = (a), arclength unknown.
/// Equations 2: balance in a (tension and moment), curvature of the free arc equal to the circle's: m = EI (1 − κ̂).
class Edge final : public VectorJoint {
 public:
  /// @param line_moment  m on the circle, EI (1 − κ̂) [EI/ρ]; EI ε more where the rod stretches
  explicit Edge(Side line_side, double line_moment = 1.0, double bending_stiffness = 1.0)
      : line_(line_side), line_moment_(line_moment), stiffness_(bending_stiffness) {}
  JointKind kind() const override { return JointKind::edge; }
  int tangent() const override { return 1; }
  bool locates() const override { return true; }
  int places() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  std::optional<Stretching> stretching(const double* w, const SmallVector& n,
                                       double compliance) const override;
  const obstacle::Surface* surface() const override { return obstacle::unit_cylinder().get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], 0.0}; }
  void adopt(const Place& place, double* w) const override { w[0] = place.angle; }

 private:
  Side line_;
  double line_moment_, stiffness_;
};

/// A section of a line contact, where the symmetry of a half chain meets it: w = (a).
class SurfaceSection final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::section; }
  int tangent() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override { w[0] = place.angle; }
};

/// A section of a free arc, likewise: w = (x, y, θ).
class FreeSection final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::section; }
  int tangent() const override { return 3; }
  std::vector<int> even(Symmetry) const override { return {1}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override {
    w[0] = place.r(0), w[1] = place.r(1), w[2] = place.heading;
  }
};

/// Far end of an infinite tail: carries nothing.
class FarEnd final : public VectorJoint {
 public:
  FarEnd(int configuration, int forces) : configuration_(configuration), forces_(forces) {}
  JointKind kind() const override { return JointKind::infinity; }
  int tangent() const override { return 0; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override { (void)place, (void)w; }

 private:
  int configuration_, forces_;
};

/// Rod end under the dead pull. moment_free: w = (θ); clamped: θ along the pull, nothing unknown.
class End final : public VectorJoint {
 public:
  End(Side arc_side, bool clamped) : arc_(arc_side), clamped_(clamped) {}
  JointKind kind() const override { return JointKind::end; }
  int tangent() const override { return clamped_ ? 0 : 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override {
    if (!clamped_) w[0] = place.heading;
  }

 private:
  Side arc_;
  bool clamped_;
};

}  // namespace windlass::contact::planar
