#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "windlass/contact/joint.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/quaternion.hpp"

/// Joints of the Kirchhoff rod. Free arcs: unit quaternion q and position r ∈ R³; line contacts: (ψ, χ), inclination and
/// twist in the frame of the obstacle's chart (rod/line_contact.hpp), and the place u there. Contacts have the coordinates
/// u = (u₀, u₁) of their obstacle's chart first; on the cylinder those are angle and height.
namespace windlass::contact::spatial {

using obstacle::SurfacePointer;

/// Frame of a rod lying on an obstacle: base · R₁(ψ) · R₃(χ), with d1 = N and d3 along u₀ at ψ = χ = 0.
/// @param base  obstacle::Surface::base_frame
rod::Quaternion surface_frame(const rod::Quaternion& base, double psi, double chi);
/// The same on the cylinder; with ψ = χ = 0 the frame of a flat rod whose tangent makes the angle a with e_x.
rod::Quaternion surface_frame(double a, double psi, double chi);

/// Increments v (half rotation vectors in the body frame) per unit u₀, ψ, χ: columns of a 3×3 matrix.
/// @param curvature  along u₀
Eigen::Matrix3d surface_spins(double curvature, double psi, double chi);

/// Inclination and twist (mod 2π) of a frame whose tangent is normal to N.
Eigen::Vector2d surface_coordinates(const rod::Quaternion& q, const rod::Quaternion& base);

/// Adds a turn to the twist where the frame of (ψ, χ) is −q: one rotation, but arcs interpolate quaternions of one sign.
void adopt_sign(const rod::Quaternion& q, const rod::Quaternion& base, double* psi_chi);

class VectorJoint : public Joint {
 public:
  int ambient() const override { return tangent(); }
  void retract(const double* w, const double* dw, double* out) const override {
    for (int i = 0; i < tangent(); ++i) out[i] = w[i] + dw[i];
  }
};

/// Isolated touch: w = (u, q), 5 degrees of freedom, arclength unknown.
/// Equations 6: tangential forces (2), moments (3), tangency d₃·N = 0.
class Touch final : public Joint {
 public:
  explicit Touch(SurfacePointer surface = obstacle::unit_cylinder()) : surface_(std::move(surface)) {}
  JointKind kind() const override { return JointKind::touch; }
  int ambient() const override { return 6; }
  int tangent() const override { return 5; }
  std::vector<int> out_of_plane() const override { return {1, 2, 4}; }
  /// The half-turn keeps turns about N, the mirror the second coordinate, across the rod, and turns about the tangent.
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector{2} : std::vector{1, 4};
  }
  int height_coordinate() const override { return 1; }
  int spin_coordinate() const override { return 4; }
  bool locates() const override { return true; }
  double slide(const double* w) const override;
  int places() const override { return 2; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  const obstacle::Surface* surface() const override { return surface_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }
  void adopt(const Place& place, double* w) const override;

 private:
  SurfacePointer surface_;
};

/// Edge of a line contact: w = (u, ψ, χ), 4 degrees of freedom, arclength unknown.
/// Equations 5: forces along the surface (2), moments about N and d₃ (2), and the normal curvature of the free arc equal to
/// the surface's,  B (u₁ sin χ + u₂ cos χ) = −B κ cos²ψ  with the strains u = K⁻¹ m + û; (1 + ε) κ where the rod stretches.
class Edge final : public VectorJoint {
 public:
  Edge(Side line_side, double bending_stiffness, SurfacePointer surface = obstacle::unit_cylinder(),
       const Eigen::Vector3d& compliance = Eigen::Vector3d::Ones(),
       const Eigen::Vector3d& natural = Eigen::Vector3d::Zero())
      : line_(line_side),
        stiffness_(bending_stiffness),
        compliance_(compliance),
        natural_(bending_stiffness * natural),
        surface_(std::move(surface)) {}
  JointKind kind() const override { return JointKind::edge; }
  int ambient() const override { return 4; }
  int tangent() const override { return 4; }
  std::vector<int> out_of_plane() const override { return {1, 2, 3}; }
  int height_coordinate() const override { return 1; }
  int spin_coordinate() const override { return 3; }
  bool locates() const override { return true; }
  double slide(const double* w) const override { return std::cos(w[2]); }
  int places() const override { return 2; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  std::optional<Drag> drag(Side side, const double* w, const Loads& loads,
                           const SmallVector& g) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  std::optional<Stretching> stretching(const double* w, const SmallVector& n,
                                       double compliance) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  const obstacle::Surface* surface() const override { return surface_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }
  void adopt(const Place& place, double* w) const override;

 private:
  Side line_;
  double stiffness_;            ///< B
  Eigen::Vector3d compliance_;  ///< B K⁻¹
  Eigen::Vector3d natural_;     ///< B û
  SurfacePointer surface_;
};

/// A section of a line contact, where the symmetry of a half chain meets it: w = (u, ψ, χ). The half-turn leaves ψ, the mirror u₁
/// and χ; so n_z and the twisting moment vanish there under the mirror, and ψ and its moment are those of the other.
class SurfaceSection final : public VectorJoint {
 public:
  explicit SurfaceSection(SurfacePointer surface = obstacle::unit_cylinder(),
                          Symmetry symmetry = Symmetry::half_turn)
      : surface_(std::move(surface)), symmetry_(symmetry) {}
  JointKind kind() const override { return JointKind::section; }
  int tangent() const override { return 4; }
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector{2} : std::vector{1, 3};
  }
  int height_coordinate() const override { return 1; }
  int spin_coordinate() const override { return 3; }
  std::vector<int> out_of_plane() const override { return {1, 2, 3}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return surface_.get(); }

 private:
  SurfacePointer surface_;
  Symmetry symmetry_;
};

/// A section of a free arc, likewise: w = (r, q), 6 degrees of freedom. On the half-turn's axis d₁ = −e_y: the rod may turn
/// about it and move along it. In the mirror its tangent is e_x: it may move along e_y and e_z and turn about the tangent, so that
/// n_y, n_z and the twisting moment vanish.
class FreeSection : public Joint {
 public:
  JointKind kind() const override { return JointKind::section; }
  int ambient() const override { return 7; }
  int tangent() const override { return 6; }
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector{1, 3} : std::vector{1, 2, 5};
  }
  int height_coordinate() const override { return 2; }
  int spin_coordinate() const override { return 5; }
  std::vector<int> out_of_plane() const override { return {2, 3, 5}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  SmallVector turned(const double* w, double turn, double spin) const override;
  void adopt(const Place& place, double* w) const override;
};

/// A place where a free arc touches another strand of the rod, or its own mirror image: w = (r, q), 6 degrees of freedom,
/// arclength unknown. Equations 7 with those of the coupling (chain::Coupling), whose force is one more unknown: forces
/// (3), moments (3), tangency e·d₃ = 0, and for both strands together the distance.
class Strand final : public FreeSection {
 public:
  JointKind kind() const override { return JointKind::touch; }
  bool locates() const override { return true; }
  int places() const override { return 3; }
  Centreline centreline(const double* w) const override;
};

/// A place of a line contact that another strand presses on: w = (u, ψ, χ), 4 degrees of freedom, arclength unknown. What of
/// the strand's force is normal to the obstacle goes straight to it, the rest is a jump of the line's forces along it: ψ
/// and χ and their moments are continuous. Equations 5 with tangency to the strand, e·t = 0. Where a cylinder slips that point
/// reaction drags, and balance is tested with displacements that it does no work on.
class Pressed final : public VectorJoint {
 public:
  explicit Pressed(SurfacePointer surface) : surface_(std::move(surface)) {}
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 4; }
  bool locates() const override { return true; }
  int height_coordinate() const override { return 1; }
  int spin_coordinate() const override { return 3; }
  std::vector<int> out_of_plane() const override { return {1, 2, 3}; }
  double slide(const double* w) const override { return std::cos(w[2]); }
  int places() const override { return 2; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  std::optional<Drag> drag_of_push(const double* w, const Loads& loads,
                                   const Eigen::Vector3d& force) const override;
  Centreline centreline(const double* w) const override;
  void place_curvature(const double* w, const Eigen::Vector3d& f, SmallMatrix& out) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return surface_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }

 private:
  SurfacePointer surface_;
};

/// Rod end under the dead pull.
///  - nothing held: free of moment, the frame turns as it likes: w = (q), 3 degrees of freedom;
///  - frame held: along the pull, as in the untwisted planar rod: nothing unknown. See HeldEnd for what is between.
class End final : public Joint {
 public:
  End(Side arc_side, bool clamped) : arc_(arc_side), clamped_(clamped) {}
  JointKind kind() const override { return JointKind::end; }
  int ambient() const override { return clamped_ ? 0 : 4; }
  int tangent() const override { return clamped_ ? 0 : 3; }
  std::vector<int> out_of_plane() const override { return clamped_ ? std::vector<int>{} : std::vector{0, 2}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  Side arc_;
  bool clamped_;
};

/// Rod end in a universal joint under the dead pull: it bends as it likes and cannot spin. One axis of the joint is e_z, the
/// other d₁, which stays normal to it: w = (α, β), the frame of a flat rod turned by α about e_z and by β about d₁. Its
/// moment is along e_z × d₁, the tangent's direction in the plane of the pulls.
class HeldEnd final : public Joint {
 public:
  JointKind kind() const override { return JointKind::end; }
  int ambient() const override { return 2; }
  int tangent() const override { return 2; }
  std::vector<int> out_of_plane() const override { return {1}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  void adopt(const Place& place, double* w) const override;
};

/// Rod end with a place of its own: w = (so many coordinates of the place, those of the frame), the frame held as by an End or a
/// HeldEnd.
class PlacedEnd : public Joint {
 public:
  PlacedEnd(int places, Side arc_side, std::unique_ptr<Joint> frame)
      : places_(places), arc_(arc_side), frame_(std::move(frame)) {}
  JointKind kind() const override { return JointKind::end; }
  int ambient() const override { return places_ + frame_->ambient(); }
  int tangent() const override { return places_ + frame_->tangent(); }
  std::vector<int> out_of_plane() const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  void retract(const double* w, const double* dw, double* out) const override;

 protected:
  /// What the arc gets of the frame; the place is zero yet.
  Attachment attached_frame(Side side, const double* w, const Loads& loads) const;
  void adopt_frame(const Place& place, double* w) const { frame_->adopt(place, w + places_); }
  /// 1: the arc that ends here is the right half of the rod; −1.
  double outward() const { return arc_ == Side::left ? 1.0 : -1.0; }

 private:
  int places_;
  Side arc_;
  std::unique_ptr<Joint> frame_;
};

/// Rod end on a slider: under its pull it moves along a guide, the line parallel to the pull at `guide_offset` from the axis and at
/// `guide_height`, and nowhere else. w = (x, those of the frame), x along the pull. What holds the end across the guide is the force of
/// its arc, three unknowns whose equations are X_b − X_a = ∫ r'; equations here: the force along the guide, which is the pull, and
/// those of the frame, held as by an End or a HeldEnd.
class GuidedEnd final : public PlacedEnd {
 public:
  GuidedEnd(Side arc_side, std::unique_ptr<Joint> frame) : PlacedEnd(1, arc_side, std::move(frame)) {}
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  SmallVector dead_load(const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  /// Direction of the pull.
  Eigen::Vector3d along(const Loads& loads) const;
};

/// End of a free rod along e_x, y = z = 0; see EndKind. x is imposed by the shortening, x = ±(1 − shortening)·half_length, or
/// the first coordinate under the dead thrust.
///  - clamped: frame turned by ±twist/2 about e_x;
///  - pinned: free of moment, the frame turns as it likes: coordinates (q);
///  - clamped beside a straight line contact along e_x, with a hinge for its clamp: a turn about `hinge` is one more
///    coordinate. H = m²/2B + n·d₃ is the same at both ends of the flat arc between, and so is n·d₃: the moment vanishes at
///    the clamp as it does at the edge. With the clamp imposed the equations have a double root there (the arc is a whole
///    wave, P ℓ² = 4π² B, about to buckle by itself); with its moment, a simple one, and the turn is zero by H.
class FreeRodEnd final : public Joint {
 public:
  FreeRodEnd(Side arc_side, bool under_thrust, bool pinned, std::optional<Eigen::Vector3d> hinge = {})
      : arc_(arc_side), under_thrust_(under_thrust), pinned_(pinned), hinge_(std::move(hinge)) {}
  JointKind kind() const override { return JointKind::end; }
  int ambient() const override { return under_thrust_ + (pinned_ ? 4 : hinge_ ? 1 : 0); }
  int tangent() const override { return under_thrust_ + (pinned_ ? 3 : hinge_ ? 1 : 0); }
  std::vector<int> fixed_in_variations() const override {
    return hinge_ ? std::vector<int>{under_thrust_} : std::vector<int>{};
  }
  double out_of_clamp(const double* w) const override { return hinge_ ? w[under_thrust_] : 0.0; }
  int spin_coordinate() const override { return pinned_ ? under_thrust_ + 2 : -1; }
  std::vector<int> out_of_plane() const override {
    return pinned_ ? std::vector<int>{under_thrust_, under_thrust_ + 2} : std::vector<int>{};
  }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  SmallVector dead_load(const double* w, const Loads& loads) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  SmallVector turned(const double* w, double turn, double spin) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  Side arc_;
  bool under_thrust_, pinned_;
  std::optional<Eigen::Vector3d> hinge_;  ///< its axis
};

}  // namespace windlass::contact::spatial
