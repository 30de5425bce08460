#pragma once

#include <array>

#include "windlass/contact/spatial_joints.hpp"

/// Joints of a rod that a cylinder and a plate z = const hold at once.
namespace windlass::contact::spatial {

/// A place of a line contact that touches a plate, too: w = (u₀, ψ, χ), 3 degrees of freedom, arclength unknown. The plate's
/// force is a jump of the line's force along the axis; ψ, χ and their moments are continuous. Equations 4: force round the
/// axis, moments (2), and the place is the line's highest, sin ψ = 0. In a rod that is its own mirror image under x → −x it is
/// at s = 0, and sin ψ = 0 follows: so where the line is flat, too, and has no highest place.
class Stopped final : public VectorJoint {
 public:
  Stopped(SurfacePointer line, SurfacePointer plate, bool in_the_middle);
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 3; }
  bool locates() const override { return !in_the_middle_; }
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector{1} : std::vector{2};
  }
  int spin_coordinate() const override { return 2; }
  double slide(const double* w) const override { return std::cos(w[1]); }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return plate_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override;

 private:
  double height() const { return plate_->chart(Eigen::Vector2d::Zero()).r(2); }
  SurfacePointer line_, plate_;
  bool in_the_middle_;
};

/// A section of a line on cylinder and plate, where the mirror of a half chain meets it: w = (u₀, χ). The twisting moment vanishes.
class FlatSection final : public VectorJoint {
 public:
  FlatSection(SurfacePointer line, const SurfacePointer& plate);
  JointKind kind() const override { return JointKind::section; }
  int tangent() const override { return 2; }
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector<int>() : std::vector{1};
  }
  int spin_coordinate() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return line_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], height_}; }

 private:
  SurfacePointer line_;
  double height_;
};

/// Edge of a line on cylinder and plate (rod/plate_line_arc.hpp) with a free arc behind: w = (u₀, χ), 2 degrees of freedom,
/// arclength unknown. Equations 3: those of an Edge with ψ = 0 at the plate's height, for force round the axis, moment
/// along the rod, and the normal curvature; the plate takes the other two, mu f of the friction among them.
class FlatEdge final : public VectorJoint {
 public:
  FlatEdge(Side line_side, double bending_stiffness, SurfacePointer line, const SurfacePointer& plate);
  JointKind kind() const override { return JointKind::edge; }
  int tangent() const override { return 2; }
  bool locates() const override { return true; }
  int spin_coordinate() const override { return 1; }
  int places() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  std::optional<Stretching> stretching(const double* w, const SmallVector& n,
                                       double compliance) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return edge_.surface(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], height_}; }

 private:
  Eigen::Vector4d on_edge(const double* w) const { return {w[0], height_, 0.0, w[1]}; }
  Side line_;
  Edge edge_;
  double height_;
};

/// A touch of the cylinder where the rod touches a plate, too: w = (a, ψ, χ), the place round the axis, the inclination in the
/// plate and the turn about the tangent, 3 degrees of freedom, arclength unknown. A plate that pushes where the rod goes on has it
/// tangent to itself, so that frames here turn about its normal and the rod's tangent only. Equations 4: force round the
/// axis, moments about e_z and the tangent, and tangency to the cylinder. The plate takes the force along the axis, the friction's
/// mu f among it. About the cylinder's normal it gives no moment: there is none where the rod lies flat beside the touch.
class FlatTouch final : public VectorJoint {
 public:
  FlatTouch(SurfacePointer cylinder, SurfacePointer plate);
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 3; }
  bool locates() const override { return true; }
  std::vector<int> out_of_plane() const override { return {2}; }
  std::vector<int> even(Symmetry symmetry) const override {
    return symmetry == Symmetry::half_turn ? std::vector<int>() : std::vector{2};
  }
  int spin_coordinate() const override { return 2; }
  int places() const override { return 1; }
  double slide(const double* w) const override;
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return touch_.surface(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], height_}; }

 private:
  std::array<double, 6> as_touch(const double* w) const;
  /// Degrees of freedom of the touch by those here.
  SmallMatrix by_own(const double* w) const;
  Touch touch_;
  rod::Quaternion base_;  ///< of the plate
  double height_;
};

/// A place where a rod that lies in a plate, free on both sides, touches another strand of the rod: w = (u, ψ, χ), place and
/// inclination in the plate and the turn about the tangent, 4 degrees of freedom, arclength unknown. As at a FlatTouch frames turn
/// about the plate's normal and the tangent only. Equations 5 with tangency to the strand: forces in the plate (2), moments about
/// its normal and the tangent, e·t = 0. What of the strand's force is normal to the plate goes straight to it.
class FlatStrand final : public VectorJoint {
 public:
  explicit FlatStrand(const SurfacePointer& plate) : free_(Side::left, 1.0, plate), pressed_(plate) {}
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 4; }
  bool locates() const override { return true; }
  int spin_coordinate() const override { return 3; }
  int places() const override { return 2; }
  Attachment attach(Side, const double* w, const Loads& loads) const override {
    return free_.attach(Side::right, w, loads);
  }
  void curvature(Side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override {
    free_.curvature(Side::right, w, loads, g_q, f, out);
  }
  Centreline centreline(const double* w) const override { return pressed_.centreline(w); }
  void adopt(const Place& place, double* w) const override { free_.adopt(place, w); }
  const obstacle::Surface* surface() const override { return free_.surface(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], w[1]}; }

 private:
  Edge free_;  ///< its free side
  Pressed pressed_;
};

/// A place of a line on cylinder and plate where another strand presses on it: w = (u₀, χ), 2 degrees of freedom, arclength unknown.
/// Equations 3 with tangency to the strand: force round the axis, moment along the rod, e·t = 0. What of the strand's force is
/// normal to the cylinder goes straight to it and drags (drag_of_push), what is along the axis straight to the plate.
class FlatPressed final : public VectorJoint {
 public:
  FlatPressed(SurfacePointer line, const SurfacePointer& plate);
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 2; }
  bool locates() const override { return true; }
  int spin_coordinate() const override { return 1; }
  int places() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  std::optional<Drag> drag_of_push(const double* w, const Loads& loads,
                                   const Eigen::Vector3d& force) const override;
  Centreline centreline(const double* w) const override;
  void place_curvature(const double* w, const Eigen::Vector3d& f, SmallMatrix& out) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return pressed_.surface(); }
  Eigen::Vector2d on_surface(const double* w) const override { return {w[0], height_}; }

 private:
  Eigen::Vector4d on_line(const double* w) const { return {w[0], height_, 0.0, w[1]}; }
  SurfacePointer line_;
  Pressed pressed_;
  double height_;
};

/// Rod end under its dead pull that touches a plate: w = (x, y, those of the frame), free to slide on the plate, which pushes it
/// with what its arc's force, three unknowns whose equations are X_b − X_a = ∫ r', has along the plate's normal. Equations here: the
/// two forces in the plate, which are the pull, and those of the frame, held as by an End or a HeldEnd.
class EndOnPlate final : public PlacedEnd {
 public:
  EndOnPlate(Side arc_side, std::unique_ptr<Joint> frame, SurfacePointer plate)
      : PlacedEnd(2, arc_side, std::move(frame)), plate_(std::move(plate)) {}
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  SmallVector dead_load(const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  SurfacePointer plate_;
};

/// Where a line on cylinder and plate leaves the plate and goes on along the cylinder: w = (u₀, χ), 2 degrees of freedom,
/// arclength unknown. Equations 3: force round the axis, moment along the rod, and no moment about N (the line on the plate
/// has none, and a plate gives none). The plate's point force is a jump of the force along the axis.
class LiftOff final : public VectorJoint {
 public:
  LiftOff(Side flat_side, SurfacePointer line, SurfacePointer plate);
  JointKind kind() const override { return JointKind::edge; }
  int tangent() const override { return 2; }
  bool locates() const override { return true; }
  int spin_coordinate() const override { return 1; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void adopt(const Place& place, double* w) const override;
  const obstacle::Surface* surface() const override { return plate_.get(); }
  Eigen::Vector2d on_surface(const double* w) const override;

 private:
  Side flat_;
  SurfacePointer line_, plate_;
  double height_;
};

}  // namespace windlass::contact::spatial
