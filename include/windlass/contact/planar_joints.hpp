#pragma once

#include "windlass/contact/joint.hpp"

/// Joints of the planar elastica round the unit circle.
///
/// The mid-point s = 0 is held along the rod (odd variations keep a, x or s there): under two equal dead pulls a
/// frictionless rod slides along itself at a cost of order exp(−2√T L_tail), a rigid motion for long tails.
///
///  Configuration θ; position (x, y) on free arcs, the angle a on
/// a line contact. Contact place: X(a) = (sin a, −cos a), outward normal N(a) = X(a).
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
class Touch : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 2; }
  bool locates() const override { return true; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  double angle(const double* w) const override { return w[0]; }
  void adopt(const Place& place, double* w) const override { w[0] = place.angle, w[1] = place.heading; }
};

/// The mid-point of a full chain on a touch: s = 0, and the force that holds it there is unknown. (Balance would give
/// tangency, because a rod free to slide under equal pulls has the same H = n·t + m²/2B left and right of the touch; but
/// only as far as the touch's force is not zero.)
class MarkerTouch final : public Touch {
 public:
  bool locates() const override { return false; }
  bool held() const override { return true; }
  double slide(const double* w) const override { return location(w, {}, {}).by_w(0); }
};

/// End of a line contact: w = (a), arclength unknown.
/// Equations 2: balance in a (tension and moment), curvature of the free arc equal to the circle's: |m| = EI.
class Edge final : public VectorJoint {
 public:
  explicit Edge(Side line_side, double bending_stiffness = 1.0)
      : line_(line_side), stiffness_(bending_stiffness) {}
  JointKind kind() const override { return JointKind::edge; }
  int tangent() const override { return 1; }
  bool locates() const override { return true; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  double angle(const double* w) const override { return w[0]; }
  void adopt(const Place& place, double* w) const override { w[0] = place.angle; }

 private:
  Side line_;
  double stiffness_;
};

/// Mirror point s = 0 on a line contact: a = 0, nothing unknown, in odd variations too (sliding is held).
class MidLine final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::mid; }
  int tangent() const override { return 0; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override { (void)place, (void)w; }
};

/// Mirror point on a free arc: x = 0, θ = 0 (mod 2π, held), w = (y). Odd variations: θ.
class MidGap final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::mid; }
  int tangent() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Attachment attach_odd(const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override { w[0] = place.r(1); }
};

/// The mid-point of a full chain on a free arc: w = (y, θ), x = 0 held. (On a line contact MidLine serves.)
class MarkerGap final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::marker; }
  int tangent() const override { return 2; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override { w[0] = place.r(1), w[1] = place.heading; }
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

/// Mirror point on a touch at the south pole: nothing unknown. Odd variations: (a, θ), the arclength held.
class MidTouch final : public VectorJoint {
 public:
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 0; }
  bool held() const override { return true; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Attachment attach_odd(const double* w, const Loads& loads) const override;
  void curvature_odd(const double* w, const SmallVector& f, SmallMatrix& out) const override;
  void adopt(const Place& place, double* w) const override { (void)place, (void)w; }
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
