#pragma once

#include <string>

#include "continuation/options.hpp"
#include "continuation/problem.hpp"

namespace continuation {

/// Extra unknowns y and equations that border F = 0:
///
///     F(x, p) + Ψ β = 0,      Cᵀu + D y = g,      y = (Δp, β) or β,
///
/// with u the sum of the state's increments since a base and Δp the change of the varied parameter since
/// there. Keller's constraint is Ψ empty, C = dual(t_x), D = t_p, g = ds; a fixed parameter is C = 0, D = 1,
/// g = Δp.
struct Borders {
  Eigen::Index parameter = -1;  ///< the parameter that varies; -1: none
  double scale = 1.0;           ///< its unit in the metric
  Matrix psi;                   ///< Ψ, n×m, m may be 0
  Matrix c;                     ///< C, n×q, q = m + (1 if a parameter varies)
  Matrix d;                     ///< D, q×q
  Vector g;                     ///< g, q
};

/// What Newton's method changes. u and y are relative to the base of the borders.
struct Iterate {
  Vector x;  ///< stored state
  Vector u;  ///< sum of increments; shape n
  Vector p;  ///< all parameters
  Vector y;  ///< extra unknowns; shape q
};

struct CorrectorReport {
  bool converged = false;
  int iterations = 0;      ///< corrections above the tolerance; an exact guess takes none
  int factorizations = 0;  ///< calls of Problem::factor
  double contraction =
      0.0;  ///< |δ₁|/|δ₀| with one factorisation; 0 if the first correction was within tolerance
  double increment = 0.0;      ///< last |δ|
  double residual = 0.0;       ///< last max |F + Ψβ|
  bool factored_here = false;  ///< the last factorisation was made at the returned state, with these borders
  std::string failure;         ///< why it did not converge
};

/// Newton's method on the bordered system.
///
/// A factorisation is kept for further corrections (chord method) as long as the observed contraction θ
/// promises the tolerance within three of them, |δ| θ³ ≤ tolerance; the trial costs one solve where it
/// fails. A correction that grows on a fresh factorisation rejects the solve. Accepted on increment and
/// residual together. std::domain_error and std::runtime_error from the problem, NaN and infinity are
/// failures, not exceptions.
CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options);

}  // namespace continuation
