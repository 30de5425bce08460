#pragma once

#include "windlass/contact/spatial_joints.hpp"
#include "windlass/rod/layered_line.hpp"

namespace windlass::contact::spatial {

/// Edge of a line contact with a cylinder that slips along the rod, whose friction has a moment about the centre line or stretches
/// the rod (rod/coupled_line_arc.hpp): w = (u, ψ, χ, F), arclength unknown; F the force that the edge carries beside the line's
/// pressure. With W = w E = mu d_t (r + k B cos²ψ)
///
///  - where the pressure flows in from the edge, F is the flux w p there, the force of a layer as long as |w|: no point force;
///  - else F is a point force, with its friction F mu d and moment: m_b jumps by r mu d_t F, λ by k mu d_t F, and the gap begins with
///    B g'' = λ |W| F, λ that of the free side.
///
/// Equations 6: those of an Edge, of which the location is that curvature, and the jump of the force along the normal,
/// F = ±(N·n − n_N), n_N of the line without what flows in.
class CoupledEdge final : public Joint {
 public:
  CoupledEdge(Side line_side, double bending_stiffness, SurfacePointer surface = obstacle::unit_cylinder())
      : line_(line_side),
        stiffness_(bending_stiffness),
        surface_(surface),
        edge_(line_side, bending_stiffness, surface) {}
  JointKind kind() const override { return JointKind::edge; }
  int ambient() const override { return 5; }
  int tangent() const override { return 5; }
  int height_coordinate() const override { return edge_.height_coordinate(); }
  int spin_coordinate() const override { return edge_.spin_coordinate(); }
  int force_coordinate() const override { return 4; }
  bool locates() const override { return true; }
  double slide(const double* w) const override { return edge_.slide(w); }
  int places() const override { return edge_.places(); }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  std::optional<Drag> drag(Side side, const double* w, const Loads& loads,
                           const SmallVector& g) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  std::optional<Lift> lift(const double* w, const Loads& loads) const override;
  std::optional<Stretching> stretching(const double* w, const SmallVector& n,
                                       double compliance) const override;
  double flux(const double* w, const Loads& loads) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  const obstacle::Surface* surface() const override { return surface_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }
  void adopt(const Place& place, double* w) const override;

 private:
  /// W, positive where the pressure flows in, with its derivatives with ψ and ω.
  struct Inflow {
    double value, by_psi, by_travel;
    bool any() const { return value > rod::narrowest_layer; }
  };
  Inflow inflow(double psi, const Loads& loads) const;
  double side() const { return line_ == Side::left ? 1.0 : -1.0; }
  Side line_;
  double stiffness_;  ///< B
  SurfacePointer surface_;
  Edge edge_;
};

}  // namespace windlass::contact::spatial
