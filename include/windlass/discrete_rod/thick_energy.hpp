#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "windlass/discrete_rod/strand_pairs.hpp"

namespace windlass::discrete_rod {

/// Stiffnesses and multipliers of `ThickEnergy`.
struct ThickPenalties {
  double cylinder = 0.0;    ///< κ, force per penetration and length [EI/ρ⁴]
  double strands = 0.0;     ///< the same, of a strand on another
  double stretching = 0.0;  ///< EA [EI/ρ²]
  double mid_point =
      0.0;  ///< of a spring along e_y at s = 0, where nothing else holds the rod: it carries nothing [EI/ρ³]
  double strand_shift = 0.0;    ///< added to the distance 2r at which strands begin to push [ρ]
  std::vector<double> tension;  ///< multipliers of the elements' lengths [EI/ρ²]
};

/// Energy of half a thick rod round the cylinder, as value, gradient, Hessian; lengths by an
/// augmented Lagrangian:
///
///     E = ∫ ½ |r'×r''|²/|r'|⁵ du + Σ_e [N_e (l_e − h_e) + ½ EA (l_e − h_e)²/h_e] − T·r(L/2)
///         + ∫ ½ κ_c max(0, 1 − ϱ)² ds + ½ ∫ ½ κ_s max(0, 2r − d(s))² ds,
///
/// ϱ the distance to the axis, d(s) that from r(s) to another strand (each of two strands is seen from the
/// other: hence ½). An isotropic, naturally straight rod whose ends are free of moment carries no twist, so
/// that this is all of it. Contact is a density along smooth curves: it knows no nodes, and does not lock.
class ThickEnergy {
 public:
  using Vector = Eigen::VectorXd;
  using Sparse = Eigen::SparseMatrix<double>;

  /// @param angle   capstan angle φ
  /// @param radius  of the rod, r [ρ]
  ThickEnergy(const SplineRod& rod, double tension, double angle, double radius);

  ThickPenalties penalties;

  Eigen::Index size() const { return rod_.size(); }
  double value(const Vector& x) const;
  Vector gradient(const Vector& x) const;
  Sparse hessian(const Vector& x) const;

  double bending(const Vector& x) const;          ///< of the whole rod [EI/ρ]
  double cylinder_force(const Vector& x) const;   ///< R_tot [EI/ρ²]
  double strand_force(const Vector& x) const;     ///< sum of the sizes of the forces between strands
  double strand_distance(const Vector& x) const;  ///< least one found; 2r + shift if no strand pushes
  /// Do strands pass through each other on the straight way between two shapes? Taken to do so where that way is long.
  bool strands_pass(const Vector& from, const Vector& to) const;
  double stretch(const Vector& x) const;  ///< largest |l_e/h_e − 1|
  void raise_tension(const Vector& x);    ///< N_e += EA (l_e/h_e − 1)

 private:
  struct Sum;
  struct Local;
  void add_bending(const Vector& x, Sum& sum) const;
  void add_lengths(const Vector& x, Sum& sum) const;
  void add_end(const Vector& x, Sum& sum) const;
  void add_mid_point(const Vector& x, Sum& sum) const;
  void add_cylinder(const Vector& x, Sum& sum) const;
  void add_strands(const Vector& x, Sum& sum) const;
  Sum evaluate(const Vector& x, bool derivatives) const;
  double element_length(const Vector& x, int element) const;
  std::vector<StrandPair> touching(const Vector& x) const;

  const SplineRod& rod_;
  double radius_;
  Eigen::Vector3d pull_;
};

}  // namespace windlass::discrete_rod
