#pragma once

#include "windlass/chain/chain.hpp"
#include "windlass/chain/topology.hpp"

/// The second variation of a chain on its active contacts as an operator, for its spectrum.
namespace windlass::chain {

/// The arcs of a chain at an equilibrium, linearised for variations of either parity.
///
/// A closed-form tail has condensed the motions of its inside away, and a spectrum needs them: a collocation arc takes its
/// place here, on the exact elastica. An infinite tail becomes one that ends, free of moment, where it is straight to
/// rounding: a mode below the pull T decays before, and the others are those of a long rod.
class Linearisation {
 public:
  /// Reads the factors that chain.factor() left at (x, loads). Chain and x must stay while this is in use.
  Linearisation(const Chain& chain, const RodKind& rod, const VectorXd& x, const Loads& loads);

 private:
  friend class Variation;
  struct Part {
    std::unique_ptr<Arc> shortened;  ///< factors of a neutral arc, see Chain::shortened; null: the arc's own
    std::unique_ptr<Arc> tail;       ///< in the place of a closed form; null: the chain's own arc
    MatrixXd nodes;                  ///< of the tail, both ends included; ambient × N
    bool joint_first = true;         ///< of the tail: its joint is at its start
    const Arc* arc = nullptr;
    Chain::Placed placed;
    bvp::EndsMatrix condensed;
    VectorXd root;                                ///< of the mass of interior and end configurations
    std::vector<Eigen::Triplet<double>> hessian;  ///< over interior, then ends
    MatrixXd
        slope;  ///< dq/ds in the order of `root`, times the share that moves with the left and with the right end
  };
  Part own_part(int link) const;
  Part tail_part(const RodKind& rod, int link) const;
  void measure(Part& part, bool touches) const;

  const Chain& chain_;
  const VectorXd& x_;
  Loads loads_;
  std::vector<Part> parts_;
  double stiffest_ = 0.0;  ///< of the motions the mesh holds [EI/ρ²]
};

/// Variations of one parity. K is symmetric and indefinite (multipliers), its metric M = W Wᵀ, where Wᵀv are the rotations
/// at material points times the root of the length each stands for. With them
///
///     K v = μ M v   ⇔   Wᵀ K⁻¹ W y = y/μ,   v = μ K⁻¹ W y,
///
/// an ordinary symmetric problem; K⁻¹ costs a sweep over the arcs' own factors.
class Variation {
 public:
  /// @param at  must stay while this is in use
  Variation(const Linearisation& at, contact::Parity parity);

  Eigen::Index size() const { return size_; }  ///< unknowns v; Chain::as_increment reads the first of them
  Eigen::Index points() const { return points_; }  ///< numbers in Wᵀv
  /// Negative eigenvalues by the inertia of the factors, without a neutral turn's.
  int negative() const { return negative_; }
  /// Is one of the eigenvalues zero because a turn of the whole rod costs nothing (Chain::expect_neutral_turn)?
  bool neutral() const { return neutral_; }

  /// Eigenvalues smaller than this are zero, see Chain::neutral_size; the inertia counts them as positive.
  double neutral_size() const { return neutral_size_; }

  VectorXd rotations(const VectorXd& v) const;                ///< Wᵀ v
  VectorXd loads(const Eigen::Ref<const VectorXd>& y) const;  ///< W y
  VectorXd solve(VectorXd f) const;                           ///< K⁻¹ f, by the arcs' factors
  /// The motion g of a neutral turn or of another zero eigenvalue, K g = 0; empty: there is none. solve() then is for f with gᵀf = 0.
  const VectorXd& neutral_motion() const { return neutral_motion_; }
  VectorXd product(const VectorXd& v) const;  ///< K v, by the arcs' uncondensed Hessians

  /// vᵀKv / vᵀMv by the arcs' uncondensed Hessians, whose error is the square of v's, and what rounding may have made of
  /// it: eps times the sum of the sizes of all terms.
  struct Quotient {
    double value, rounding;
  };
  Quotient quotient(const VectorXd& v) const;

  /// Negative eigenvalues but those that rounding may have made, and how many of these there are.
  struct Doubt {
    int negative = 0, rounded = 0;
  };
  Doubt doubt() const;

 private:
  /// One arc's place in v, in the dense block and in Wᵀv.
  struct Place {
    const Linearisation::Part* part;
    Chain::Local local;
    std::vector<Eigen::Index> at;             ///< of local.dofs in v
    Eigen::Index interior, first;             ///< of v, of Wᵀv
    Eigen::Index left = -1, right = -1;       ///< in v, of a touch's arclength
    std::vector<Chain::Border> borders = {};  ///< dense unknowns that act on the interior
  };
  void place(Chain::Purpose purpose, const Chain::Numbering& numbering, int link);
  void hold(Block& dense, const VectorXd& d, double by);
  void hold_null(Block& dense);
  /// Of pivots: the one in the middle, and that of a held direction (bvp::Held) before anything cancels, 1.
  double size_of(const VectorXd& values) const;
  void expand(const VectorXd& y, VectorXd& v) const;
  void hold_phase(Chain::Purpose purpose, const Chain::Numbering& numbering, Block& dense);
  void hold_slide(Chain::Purpose purpose, const Chain::Numbering& numbering, Block& dense);
  void add_borders(Block& dense);
  /// Values of v at a place's local unknowns.
  VectorXd gathered(const Place& place, const VectorXd& v) const;

  const Linearisation& at_;
  std::vector<Place> places_;
  std::vector<Eigen::Index> dense_;  ///< places in v of the unknowns of the dense block
  Eigen::Index size_ = 0, points_ = 0, phase_ = -1, slide_ = -1;
  Eigen::Index unknowns_ = 0;  ///< of the dense block, with those that v lacks (bvp::Held)
  int negative_ = 0;
  bool neutral_ = false;
  double neutral_size_ = 0.0;
  VectorXd neutral_motion_;
  std::vector<Eigen::Index> locations_;  ///< rows of touches' arclengths in the dense block, −1: none
  Block condensed_;                      ///< dense block, before anything is held in it
  int condensed_negative_ = 0;           ///< negative eigenvalues that it adds to
  std::vector<Eigen::Triplet<double>> joints_;  ///< terms of the dense block that no arc makes
  VectorXd motion_, slid_by_;                   ///< rows over v of the phase and of a knot's slide
  std::shared_ptr<const class SymmetricFactors> factors_;
};

}  // namespace windlass::chain
