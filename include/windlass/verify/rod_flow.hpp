#pragma once

#include <Eigen/Dense>
#include <memory>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"
#include "windlass/verify/shape.hpp"

namespace windlass::verify {

/// State of a cross-section in the world frame: position [ρ], quaternion (w, x, y, z), moment [EI/ρ], force [EI/ρ²].
struct Section {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  Eigen::Vector4d q = {1, 0, 0, 0};
  Eigen::Vector3d m = Eigen::Vector3d::Zero();
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
};

/// Material law m_body = K (u - û), K = diag(EI1, EI2, GJ), and r' = (1 + k n·d3) d3.
struct Stiffness {
  Eigen::Vector3d K = {1, 1, 1};
  Eigen::Vector3d u_hat = {0, 0, 0};
  double k = 0.0;                      ///< 1/EA [ρ²/EI]
  Eigen::Vector3d weight = {0, 0, 0};  ///< known force per length, world frame [EI/ρ³]

  explicit Stiffness(const scene::Rod& rod);
  Eigen::Vector3d strain(const Section& section) const;  ///< u, body frame [1/ρ]
  double energy_density(const Section& section) const;   ///< W = ½ (u-û)·K(u-û)
  /// H = m·u - W + n·d3 + k (n·d3)²/2 + weight·r
  double hamiltonian(const Section& section) const;
  double stretch(const Section& section) const;  ///< |r'| = 1 + k n·d3
  bool stretches() const { return k != 0.0; }
  bool weighs() const { return !weight.isZero(); }
};

Eigen::Matrix3d rotation(const Eigen::Vector4d& q);  ///< columns d1, d2, d3
Eigen::Vector3d tangent(const Section& section);     ///< d3

/// Contact force per length that keeps the centreline on the unit cylinder.
///
/// With N = (x, y, 0) and t = d3 the constraint ½(x²+y²) = ½ has the derivative h = N·t; three more derivatives along
/// an isotropic, naturally straight rod (t' = w = m×t/B, m' = n×t, n' = -pN) bring in p linearly:
///   h' = |t_h|² + N·w,  h'' = 3 t_h·w_h + N·w',  h''' = 3|w_h|² + 4 t_h·w'_h + N·w'' = 0,
/// where v_h is the horizontal part of v. This uses moments and forces only, not the surface coordinates that the
/// solver uses, so it is an independent statement of the same mechanics.
double surface_pressure(const Section& section, double bending_stiffness);
/// The same of a rod that stretches by λ = 1 + k n·t, with λ t in the place of t as the slope of the centre line: h''' is linear
/// in p, which is found from its values without any and with a unit of it.
double stretched_surface_pressure(const Section& section, const Stiffness& stiffness);

/// Does friction along a line take of the force along the normal, by its moment or because it stretches the rod? The pressure then
/// has layers.
bool has_layers(const Stiffness& stiffness, const Shape& shape);
/// That part, w p: ν − n·N, ν the force along the normal without it. The moment about the binormal b = N × t is that of the surface's
/// curvature, Bλ cos²ψ, whose rate the balance of moments knows: with c = cos ψ, s = sin ψ, D = 1 + kBc⁴ and A = m·t − 3Bλ s c
///     λ ν = ψ' A + B λ' c²,   D λ' = −k ψ' (A c² + n·(t × N)).
double taken_by_friction(const Section& section, const Stiffness& stiffness);
/// And w = mu d·t (r + k B c²)/(λ D).
double layer_width(const Section& section, const Stiffness& stiffness, const Shape& shape);

/// Through these places and values, at s (Lagrange).
double polynomial(const Eigen::VectorXd& places, const Eigen::VectorXd& values, double s);

/// Contact force per length that keeps the centreline on a plane with the normal N, for any section and natural shape.
///
/// The constraint N·t = 0 holds along the rod, and so does its third derivative, with t = R e₃ and R' = R [u]×. In the body
/// frame, with m' = −u × m + λ n × e₃, n' = −u × n − p N − w and u = K⁻¹ m + û, p enters through u'' alone, linearly.
double plane_pressure(const Section& section, const Stiffness& stiffness, const Eigen::Vector3d& normal);

/// Integrates the balance laws along one arc with CVODE.
///
/// free: r' = λ d3, q' = ½ q⊗(0,u), m' = n×r', n constant, or n' = -weight. line: the same with n' = -p N - weight and
/// p = surface_pressure, or plane_pressure.
/// Move-only owner of its CVODE memory.
class RodFlow {
 public:
  /// @param tolerance  relative; the absolute one is a tenth of it
  /// @throws std::runtime_error when CVODE cannot be set up
  /// @param shape  of a line: what it lies on
  RodFlow(const Stiffness& stiffness, equilibrium::ArcKind kind, double tolerance = 1e-12,
          const Shape& shape = Shape::cylinder());
  RodFlow(RodFlow&&) noexcept;
  RodFlow& operator=(RodFlow&&) noexcept;
  ~RodFlow();

  /// Begins at section `start`, s = 0.
  /// @param backward  against the arclength
  void restart(const Section& start, bool backward = false);
  /// Of a line whose friction has a moment about the centre line p is what the force along the normal says, taken_by_friction over
  /// w; that decays within w against the sign of w only, and says nothing where w vanishes. There: the polynomial through these
  /// places, counted from the next restart, and values; empty: none.
  void prescribe(const Eigen::VectorXd& places, const Eigen::VectorXd& pressures);
  /// Goes on to s > 0 counted from the restart, larger than before. @throws std::runtime_error when CVODE gives up
  Section advance(double s);
  /// ∫ p ds since the restart [EI/ρ²]
  double contact_force() const;
  /// ∫ (ε n·d3 − 2 weight·r) ds since the restart: what stretch and weight have of the virial [EI/ρ]
  double virial() const;
  bool on_wall() const;
  const Stiffness& stiffness() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace windlass::verify
