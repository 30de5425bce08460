#pragma once

#include <Eigen/SparseCore>
#include <cmath>

#include "windlass/discrete_rod/open_spline.hpp"
#include "windlass/pull/friction.hpp"

namespace windlass::pull {

/// What pulls and holds the rod; natural units (ρ = EI = 1).
struct Setting {
  double tension = 1.0, angle = 0.0;  ///< T, φ
  double plate = 0.0;                 ///< the centre line stays at z <= plate [ρ]
  double below = -HUGE_VAL;           ///< and at z >= below, of a second plate [ρ]
  double radius = 0.0;                ///< of a rod whose strands keep twice that apart; 0: a thin one [ρ]
  double compliance = 0.0;            ///< 1/EA of a rod that stretches [ρ²/EI]
  bool blocked = false;  ///< no travel along itself: pulls T ± τ, τ unknown; else both T and it may travel
  Coulomb coulomb;
};

/// Where the last step left the quadrature points, four an element.
struct Memory {
  Eigen::Matrix3Xd place;  ///< [ρ]
  Eigen::Matrix2Xd slip;   ///< remembered by the friction (round, along the axis) [ρ]
};

/// One step: what is at work in it.
struct Step {
  double advance = 0.0;  ///< of the cylinder along its axis [ρ]
  double damping = 0.0;  ///< force per length against motion since the last step [EI/ρ⁴]
  bool dragged = true;   ///< friction; else none, for the relaxed start
  bool plates = true;    ///< likewise
};

/// Forces and places at the end of a step.
struct Measured {
  double drag = 0.0;                 ///< F, of the cylinder on the rod along the axis [EI/ρ²]
  double plate_force = 0.0;          ///< [EI/ρ²]
  double R_tot = 0.0;                ///< ∫ p ds [EI/ρ²]
  double sticking = 0.0;             ///< part of R_tot inside the cone of friction
  double pull_difference = 0.0;      ///< τ [EI/ρ²]
  double z_low = 0.0, z_high = 0.0;  ///< [ρ]
  double moved = 0.0;                ///< mean motion, weighed by pressure, of the contact across the rod [ρ]
};

/// What presses on the rod at one quadrature point.
struct PlaceLoad {
  double s = 0.0;                      ///< arclength [ρ]
  Eigen::Vector3d force;               ///< of all obstacles [EI/ρ²]
  double cylinder = 0.0, plate = 0.0;  ///< normal forces per length [EI/ρ³]
};

/// Balance of the whole rod at the end of a step, a system for Newton's method.
///
/// Unknowns: 3 (M + 3) coordinates of control points, M tensions N_e, and τ where the travel is blocked.
/// Equations, as many:
///
///     ∂E/∂c − Σ_q w_q ∂r_q/∂c · (p N + q − κ [z − z_p]₊ e_z + κ [z₂ − z]₊ e_z − γ (r − r⁰)) = 0,
///     l_e = h_e (1 + ε_e),   ½ (r_R·e_R − r_L·e_L) = 0,
///
/// E = Σ b_e + N_e (l_e − h_e) − ½ k h_e (N_e − b_e/h_e)² − (T + τ) e_R·r_R − (T − τ) e_L·r_L, b_e = ∫ ½ κ² ds,
/// ε_e = k (N_e − b_e/h_e); p = κ_c [1 − ϱ]₊, N outward, q by Coulomb's law (`Coulomb`) from the slip g = g⁰ + (e_θ·(r − r⁰), z − z⁰ − ΔU), all of it at the end of the step (backward Euler),
/// q in the end's tangent plane. The matrix is exact and unsymmetric. The beds follow the mesh as in
/// `discrete_rod::minimise`, κ = 4/(3/2 h)⁴: forces are off by O(h³). Strands of a thick rod press on each other without friction, by
/// the same bed in the distance d from each place to the nearest of another strand, −½ κ [2r − d]₊ ∂d/∂c, half of it from either.
class DraggedRod {
 public:
  using Vector = Eigen::VectorXd;
  using Sparse = Eigen::SparseMatrix<double>;
  using Spline = discrete_rod::OpenSpline;

  /// @param h  of the fine elements [ρ]
  DraggedRod(Spline spline, const Setting& setting, double h);

  Setting setting;

  const Spline& spline() const { return spline_; }
  /// Distance from an obstacle within which its bed begins to push [ρ].
  double reach() const { return rounding_; }
  double stiffness() const { return bed_; }  ///< of the beds, force per length and depth [EI/ρ⁴]
  Eigen::Index size() const { return spline_.size() + spline_.elements() + (setting.blocked ? 1 : 0); }
  /// Unknowns of a shape under the pulls alone.
  Vector unknowns(const Vector& controls) const;
  /// Residual, and with `matrix` its derivative; the pattern is always the same, but where strands touch.
  void evaluate(const Vector& u, const Memory& last, const Step& step, Vector& residual,
                Sparse* matrix) const;
  /// @param u  end of the step that begins at `last`
  Measured measured(const Vector& u, const Memory& last, const Step& step) const;
  /// What the next step begins from. @param fresh  forgets all slip
  Memory memory(const Vector& u, const Memory& last, const Step& step) const;
  Memory fresh_memory(const Vector& u) const;
  /// At every quadrature point, by increasing s.
  std::vector<PlaceLoad> loads(const Vector& u, const Memory& last, const Step& step) const;
  const Eigen::Vector3d& right_pull() const { return right_; }  ///< its direction

 private:
  /// Pressure below which contact grows softer, over T [1/ρ].
  static constexpr double softest = 0.05;
  struct Local;
  struct Place;
  Place at(const Local& local, int q, const Memory& last, const Step& step) const;
  void add_shape(Local& local) const;
  void add_contact(Local& local, const Memory& last, const Step& step) const;
  void add_ends(const Vector& u, Vector& residual, std::vector<Eigen::Triplet<double>>* entries) const;
  void add_strands(const Vector& u, Vector& residual, std::vector<Eigen::Triplet<double>>* entries) const;
  Eigen::Index tension(int element) const { return spline_.size() + element; }

  Spline spline_;
  double bed_, rounding_;
  Eigen::Vector3d left_, right_;  ///< directions of the pulls
};

}  // namespace windlass::pull
