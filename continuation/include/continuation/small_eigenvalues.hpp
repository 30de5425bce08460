#pragma once

#include <optional>

#include "continuation/problem.hpp"

namespace continuation {

/// The eigenvalues of J nearest to zero, from solves with a factorisation that is there anyway: what a problem without an
/// index() tells of crossings that the sign of a determinant cannot, two in one step.
struct SmallEigenvalues {
  Vector values;   ///< real ones; complex pairs are left out
  Matrix vectors;  ///< unit columns
  Matrix basis;    ///< of the subspace; the start for a state close by
};

/// By inverse iteration of a subspace with the last factored [J F_p; cᵀ d]; t: the tangent (t_x, t_p) from the same matrix.
/// @param start  basis of a state close by, or empty
/// @return nullopt where J is singular or the iteration is not finite
std::optional<SmallEigenvalues> small_eigenvalues(Problem& problem, const Vector& t_x, double t_p,
                                                  const Matrix& start);

/// Eigenvalues that changed sign from one state to another: those whose vectors are the same.
int sign_changes(const SmallEigenvalues& from, const SmallEigenvalues& to);

}  // namespace continuation
