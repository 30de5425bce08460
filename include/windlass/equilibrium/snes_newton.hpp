#pragma once

#include <continuation/bordered_newton.hpp>
#include <memory>

/// Newton's method of branches, starts and entries, through PETSc's SNES.
namespace windlass::equilibrium {

/// Solves bordered systems by SNES: newtonls with full steps, KSPPREONLY and,
/// as its preconditioner, the problem's own bordered factorisation in a
/// PCSHELL. PETSc's options and monitors act on every solve.
///
/// SNES works with the increment δ from a base, F(δ) = F(retract(base, δ)).
/// Increments of frames do not commute, so before every iteration δ moves into
/// the base and returns to zero: the Jacobian, taken at δ = 0, is then the
/// exact one.
///
/// When to factor anew and when to stop is the continuation library's rule
/// (StoppingRule), asked in SNES's convergence test: it needs the correction
/// due at the state, which is found there and used by the iteration that
/// follows. A solve so costs as many residuals, factorisations and solutions as
/// continuation::ChordNewton.
///
/// PETSc's objects are kept for the two last sizes. Not for use from two
/// threads at a time.
class SnesNewton final : public continuation::BorderedNewton {
public:
  SnesNewton();
  ~SnesNewton() override;

  continuation::CorrectorReport
  solve(continuation::Problem &problem, const continuation::Borders &borders,
        continuation::Iterate &iterate,
        const continuation::Options &options) override;

private:
  class System; ///< PETSc's objects for one number of unknowns, and the problem
                ///< they look at
  std::unique_ptr<System> systems_[2];
  int next_ = 0; ///< the one to be replaced
};

} // namespace windlass::equilibrium
