#pragma once

#include <cmath>

#include "windlass/contact/joint.hpp"
#include "windlass/rod/quaternion.hpp"

/// Joints of the Kirchhoff rod round the unit cylinder. Free arcs: unit quaternion q and position r ∈ R³; line
/// contacts: (ψ, χ) and (a, z), see rod::SurfaceDensity. X(a, z) = (sin a, −cos a, z), N(a) = (sin a, −cos a, 0).
namespace windlass::contact::spatial {

/// Frame of a rod lying on the cylinder: Rz(a) · Q₀ · R₁(ψ) · R₃(χ), with d1 = N and d3 = e_x at a = ψ = χ = 0.
rod::Quaternion surface_frame(double a, double psi, double chi);

/// Increments v (half rotation vectors in the body frame) per unit a, ψ, χ: columns of a 3×3 matrix.
Eigen::Matrix3d surface_spins(double psi, double chi);

/// Angle, inclination and twist (a mod 2π) of a frame whose tangent is normal to N(a).
Eigen::Vector3d surface_coordinates(const rod::Quaternion& q, double a);

class VectorJoint : public Joint {
 public:
  int ambient() const override { return tangent(); }
  void retract(const double* w, const double* dw, double* out) const override {
    for (int i = 0; i < tangent(); ++i) out[i] = w[i] + dw[i];
  }
};

/// Isolated touch: w = (a, z, q), 5 degrees of freedom, arclength unknown.
/// Equations 6: tangential forces (2), moments (3), tangency d₃·N = 0.
class Touch final : public Joint {
 public:
  JointKind kind() const override { return JointKind::touch; }
  int ambient() const override { return 6; }
  int tangent() const override { return 5; }
  std::vector<int> out_of_plane() const override { return {1, 2, 4}; }
  bool locates() const override { return true; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  double angle(const double* w) const override { return w[0]; }
  double height(const double* w) const override { return w[1]; }
  void adopt(const Place& place, double* w) const override;
};

/// Edge of a line contact: w = (a, z, ψ, χ), 4 degrees of freedom, arclength unknown.
/// Equations 5: forces along the surface (2), moments about N and d₃ (2), m·D₂ = −B cos²ψ (normal curvature of the
/// free arc equal to the surface's).
class Edge final : public VectorJoint {
 public:
  Edge(Side line_side, double bending_stiffness) : line_(line_side), stiffness_(bending_stiffness) {}
  JointKind kind() const override { return JointKind::edge; }
  int ambient() const override { return 4; }
  int tangent() const override { return 4; }
  std::vector<int> out_of_plane() const override { return {1, 2, 3}; }
  bool locates() const override { return true; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  double angle(const double* w) const override { return w[0]; }
  double height(const double* w) const override { return w[1]; }
  void adopt(const Place& place, double* w) const override;
  static double& twist(double* w) { return w[3]; }

 private:
  Side line_;
  double stiffness_;
};

/// Half-turn point on a line contact: a = z = χ = 0, w = (ψ). Odd variations: χ when twist is held (clamped ends).
/// Pinned rigid motions: z (translation), a (sliding of the rod along itself, see contact::planar), and χ for ends
/// free of moment (spin).
class MidLine final : public VectorJoint {
 public:
  explicit MidLine(bool twist_held) : twist_held_(twist_held) {}
  JointKind kind() const override { return JointKind::mid; }
  int tangent() const override { return 1; }
  std::vector<int> out_of_plane() const override { return {0}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Attachment attach_odd(const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  bool twist_held_;
};

/// The mid-point of a full chain lying on a line contact: w = (ψ), or (ψ, χ) when twist is held. It pins the rigid
/// motions of the whole rod (a = z = 0; χ = 0 for ends free of moment).
class MarkerLine final : public VectorJoint {
 public:
  explicit MarkerLine(bool twist_held) : twist_held_(twist_held) {}
  JointKind kind() const override { return JointKind::marker; }
  int tangent() const override { return twist_held_ ? 2 : 1; }
  std::vector<int> out_of_plane() const override { return twist_held_ ? std::vector{0, 1} : std::vector{0}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  bool twist_held_;
};

/// The mid-point of a full chain on a free arc: w = (y, q), with x = z = 0 held, and the spin about d₃ unless twist is
/// held. 4 or 3 degrees of freedom. `along`: w = (x, y, q), for struts whose ends hold x.
class MarkerGap final : public Joint {
 public:
  explicit MarkerGap(bool twist_held, bool along = false) : twist_held_(twist_held), along_(along) {}
  JointKind kind() const override { return JointKind::marker; }
  int ambient() const override { return along_ ? 6 : 5; }
  int tangent() const override { return (along_ ? 2 : 1) + (twist_held_ ? 3 : 2); }
  std::vector<int> out_of_plane() const override {
    return twist_held_ ? std::vector{places(), places() + 2} : std::vector{places()};
  }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  int places() const { return along_ ? 2 : 1; }
  bool twist_held_, along_;
};

/// The mid-point of a full chain on a touch: w = (a, q), with s = z = 0 held, and the spin about d₃ unless twist is held.
/// 4 or 3 degrees of freedom, and the holding force (see contact::planar::MarkerTouch).
class MarkerTouch final : public Joint {
 public:
  explicit MarkerTouch(bool twist_held) : twist_held_(twist_held) {}
  JointKind kind() const override { return JointKind::touch; }
  int ambient() const override { return 5; }
  int tangent() const override { return twist_held_ ? 4 : 3; }
  std::vector<int> out_of_plane() const override { return twist_held_ ? std::vector{1, 3} : std::vector{1}; }
  bool held() const override { return true; }
  double slide(const double* w) const override { return location(w, {}, {}).by_w(0); }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const override;
  void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q, const SmallVector& f,
                 SmallMatrix& out) const override;
  void retract(const double* w, const double* dw, double* out) const override;
  double angle(const double* w) const override { return w[0]; }
  void adopt(const Place& place, double* w) const override;

 private:
  bool twist_held_;
};

/// Half-turn point on a free arc: r = (0, y, 0), frame turned by ψ about the half-turn axis e_y; w = (y, ψ).
/// Odd variations: spins about d₂ and d₃; x and z where no rigid motion is to be pinned.
class MidGap final : public VectorJoint {
 public:
  struct OddFreedom {
    bool along = false;   ///< x varies (false: sliding of the rod along itself, pinned)
    bool height = false;  ///< z varies (false: rigid translation, pinned)
    bool spin = true;  ///< spin about d₃ varies (false: rigid spin of an isotropic rod free of end moment)
    bool phase =
        false;  ///< an isotropic strut's shape may turn about e_x at no cost: held by a spring (curvature_odd)
  };
  explicit MidGap(OddFreedom odd) : odd_(odd) {}
  JointKind kind() const override { return JointKind::mid; }
  int tangent() const override { return 2; }
  std::vector<int> out_of_plane() const override { return {1}; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Attachment attach_odd(const double* w, const Loads& loads) const override;
  /// The phase condition: a spring against turning about e_x. That motion is a rigid one, so any stiffness leaves the
  /// inertia of the others as it is; a straight strut does not move in it, feels no spring, and keeps both planes.
  void curvature_odd(const double* w, const SmallVector& f, SmallMatrix& out) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  OddFreedom odd_;
};

/// Half-turn point on a touch at the south pole: w = (ψ). Odd variations: a, spins about d₂ and d₃.
class MidTouch final : public VectorJoint {
 public:
  explicit MidTouch(bool twist_held) : twist_held_(twist_held) {}
  JointKind kind() const override { return JointKind::touch; }
  int tangent() const override { return 1; }
  std::vector<int> out_of_plane() const override { return {0}; }
  bool held() const override { return true; }
  double slide(const double* w) const override { return std::cos(w[0]); }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  Attachment attach_odd(const double* w, const Loads& loads) const override;
  void curvature_odd(const double* w, const SmallVector& f, SmallMatrix& out) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  bool twist_held_;
};

/// Rod end under the dead pull. moment_free: w = (q), 3 degrees of freedom. clamped: frame along the pull, as in the untwisted planar rod.
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

/// Clamped end of a strut along e_x: frame turned by ±twist/2 about e_x, y = z = 0. x is imposed by the shortening,
/// x = ±(1 − shortening)·half_length, or w = (x) under the dead thrust.
class StrutEnd final : public VectorJoint {
 public:
  StrutEnd(Side arc_side, bool under_thrust) : arc_(arc_side), under_thrust_(under_thrust) {}
  JointKind kind() const override { return JointKind::end; }
  int tangent() const override { return under_thrust_ ? 1 : 0; }
  Attachment attach(Side side, const double* w, const Loads& loads) const override;
  SmallVector dead_load(const double* w, const Loads& loads) const override;
  void adopt(const Place& place, double* w) const override;

 private:
  Side arc_;
  bool under_thrust_;
};

}  // namespace windlass::contact::spatial
