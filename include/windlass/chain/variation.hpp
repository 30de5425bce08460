#pragma once

#include "windlass/chain/chain.hpp"

namespace windlass::chain {

/// The second variation of a chain on its active contacts as an operator: K⁻¹ by the chain's own condensation.
///
/// K is symmetric and indefinite (multipliers), of the size of Chain::second_variation; its metric is M = W Wᵀ, where
/// (Wᵀv) are the rotations of v at material points, times the root of the length each stands for. With them
///
///     K v = μ M v   ⇔   Wᵀ K⁻¹ W y = y/μ,   v = μ K⁻¹ W y,
///
/// an ordinary symmetric problem. K⁻¹ costs a sweep over the arcs, whose factors Chain::factor() has left.
class Variation {
 public:
  /// Reads the factors of the last chain.factor(), which was made at (x, loads), an equilibrium. Both must stay while this
  /// is in use.
  Variation(const Chain& chain, const VectorXd& x, const Loads& loads, contact::Parity parity);

  Eigen::Index size() const { return size_; }      ///< unknowns v
  Eigen::Index points() const { return points_; }  ///< numbers in Wᵀv
  int negative() const { return negative_; }       ///< negative μ, by the inertia of the factors
  contact::Parity parity() const { return parity_; }

  VectorXd rotations(const VectorXd& v) const;  ///< Wᵀ v; shape points()
  VectorXd loads(const VectorXd& y) const;      ///< W y; shape size()
  VectorXd solve(VectorXd f) const;             ///< K⁻¹ f; shape size()

  /// Wᵀg of the motion g of the phase gauge, of size one: an exact null vector of K, to be left out. Empty where there is none.
  const VectorXd& neutral() const { return neutral_; }

  /// What rounding leaves of a zero μ: that of the stiffest motion the mesh holds [EI/ρ²].
  double rounding() const;

 private:
  /// One arc with its place in v and in Wᵀv.
  struct Part {
    const Arc* arc;
    Chain::Local local;
    Chain::Placed placed;
    Eigen::Index interior, first;      ///< of v, of Wᵀv
    VectorXd root;                     ///< of the mass of interior and end configurations
    Eigen::Index left, right;          ///< places in v of a touch's arclength, −1: none
    VectorXd phase;                    ///< K⁻¹ g on the interior
    VectorXd left_shift, right_shift;  ///< rotation at a material point as the touch moves by 1
  };
  void add_part(const Chain& chain, const Chain::Numbering& numbering, const VectorXd& x, const Loads& loads,
                Chain::Purpose purpose, int link);

  void add_phase(const VectorXd& motion);

  contact::Parity parity_;
  std::vector<Part> parts_;
  Eigen::Index size_ = 0, points_ = 0, dense_size_ = 0;
  int negative_ = 0;
  Eigen::Index phase_ = -1;  ///< place in v of the phase gauge's multiplier
  VectorXd neutral_;
  Eigen::PartialPivLU<MatrixXd> dense_;
};

}  // namespace windlass::chain
