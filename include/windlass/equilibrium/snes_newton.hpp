#pragma once

#include <continuation/bordered_newton.hpp>
#include <functional>

/// Newton's method of branches, starts and entries, through PETSc's SNES.
namespace windlass::equilibrium {

/// Solves bordered systems by SNES: newtonls with full steps (line search `basic`), KSPPREONLY and, as its
/// preconditioner, the problem's own bordered factorisation in a PCSHELL. PETSc's options and monitors act on every solve.
///
/// SNES works with the increment δ from a base, F(δ) = F(retract(base, δ)). Increments of frames do not commute, so before
/// every iteration δ moves into the base and returns to zero: the Jacobian, taken at δ = 0, is then the exact one.
///
/// When to factor anew and when to stop is the continuation library's rule (StoppingRule), asked in SNES's convergence
/// test. It wants the correction due at the state: that is found there, and the iteration which follows uses it. A solve so
/// costs the residuals, factorisations and solutions of continuation::ChordNewton, and gives its results to the last bit.
/// The last correction is added when SNES has ended, so that no residual is evaluated for it.
///
/// -snes_max_it, -snes_stol (on the increment) and -snes_atol (on max |F| in its unit) win over the options of a solve. The
/// Jacobian is a shell that SNES is told to linearise once (-snes_lag_jacobian -2), since the rule above factors:
/// -snes_test_jacobian tests it in every iteration with -snes_lag_jacobian 1.
///
/// PETSc's objects are made once for a number of unknowns and lent to whichever problem has that many; the process keeps
/// those of the sizes used last. PETSc is not for use from two threads, nor is this.
class SnesNewton final : public continuation::BorderedNewton {
 public:
  /// Part in (0, 1] of a correction (dx, dy) that is taken at an iterate.
  using Part = std::function<double(const continuation::Iterate& at, const Eigen::VectorXd& correction)>;

  continuation::CorrectorReport solve(continuation::Problem& problem, const continuation::Borders& borders,
                                      continuation::Iterate& iterate,
                                      const continuation::Options& options) override;

  /// From a guess that may be far: every correction has factors of its own, only a part of it may be taken, and it may be
  /// longer than the one before.
  continuation::CorrectorReport solve_from_guess(continuation::Problem& problem,
                                                 const continuation::Borders& borders,
                                                 continuation::Iterate& iterate,
                                                 const continuation::Options& options, const Part& part);

  /// Sets of PETSc's objects made by this process so far.
  static int made();
};

}  // namespace windlass::equilibrium
