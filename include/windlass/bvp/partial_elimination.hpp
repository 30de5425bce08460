#pragma once

#include <Eigen/Dense>

namespace windlass::bvp {

/// Symmetric elimination of the first I of I + E unknowns, without pivoting:
///
///     [A  Bᵀ]   [L   ] [D    ] [Lᵀ Wᵀ]
///     [B  C ] = [W  I] [   S ] [    I],      S = C − W D Wᵀ.
///
/// Pivots are not exchanged because the sizes are fixed and the signs of D count the negative directions
/// (Haynsworth: inertia of the whole = inertia of D + inertia of S). A pivot below `pivot_floor` of its column's scale
/// is replaced by that floor with its sign kept; Newton then contracts linearly with a factor of about the floor,
/// which is below every tolerance in use, instead of breaking down where an arc alone is singular.
class PartialElimination {
 public:
  static constexpr double pivot_floor = 1e-9;

  void resize(int eliminated, int kept);

  /// Only the lower triangle of `full` (I+E square) is read; its trailing E×E lower triangle leaves as S.
  void factor(Eigen::MatrixXd& full);

  /// f (I) and g (E): forward elimination; g leaves as the right-hand side of S.
  void reduce(double* f, double* g) const;

  /// f as left by reduce(); y (E) solves the S system. f leaves as the solution.
  void expand(double* f, const double* y) const;

  int negative_pivots() const { return negative_; }

 private:
  int eliminated_ = 0, kept_ = 0, negative_ = 0;
  Eigen::MatrixXd columns_;        ///< L and W, (I+E) × I, below the diagonal; rows padded with zeros
  Eigen::VectorXd inverse_pivot_;  ///< 1/D
};

}  // namespace windlass::bvp
