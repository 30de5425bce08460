#pragma once

#include <Eigen/Dense>
#include <vector>

#include "windlass/equilibrium/solution.hpp"

namespace windlass::test {

/// The second variation of a state as that of a polygon, which shares with the chain the shape alone: a second count of the
/// directions that a rod gives way in. For isotropic, straight rods whose ends are free of moment: they carry no twisting moment, and their energy is
/// that of the centre line.
struct DiscreteHessian {
  double mesh = 0.1;  ///< distance of the vertices where the rod is in contact
  bool hold_slide = true;

  /// Eigenvalues of vᵀKv against ∫ |δt|² ds on the active contacts, ascending. Held are, beside contacts and lengths, motions of the
  /// whole rod that cost nothing: of a free one along and about e_x, round a cylinder along its axis.
  Eigen::VectorXd eigenvalues(const equilibrium::Solution& state) const;
};

}  // namespace windlass::test
