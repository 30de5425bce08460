#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "windlass/chain/chain.hpp"

/// Newton's method for the equilibrium of a chain, through PETSc's SNES.
namespace windlass::equilibrium {

/// When a state is accepted. What the user says after `--` (-snes_atol, -snes_stol, -snes_max_it) wins.
struct NewtonOptions {
  double residual_tolerance =
      1e-11;  ///< largest residual entry, per unit of load (see NewtonResult::residual)
  double increment_tolerance = 1e-10;  ///< largest entry of the Newton increment still due [ρ, rad, EI/ρ²]
  int max_iterations = 30;

  /// @throws std::invalid_argument naming the bound violated
  void validate() const;
};

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  double residual = 0.0;  ///< largest entry of the residual, divided by max(1, |T|, |thrust|)
  double increment =
      0.0;  ///< largest entry of the increment still due at the returned state; infinite if unknown
  std::string reason;  ///< PETSc's name of why it stopped, e.g. "CONVERGED_ITS", "DIVERGED_LINE_SEARCH"
};

/// Solves F(x) = 0 for a chain: SNES newtonls with the bt line search.
///
/// SNES works with the increment δ from a base state, F(δ) = residual(retract(base, δ)). Increments of frames do not
/// commute, so before every iteration δ moves into the base and returns to zero: the chain's Jacobian, taken at
/// δ = 0, is then the exact one. A trial step on which an arc's length is not positive is a domain error, and the
/// line search halves it.
///
/// A state is accepted if both the residual and the increment still due are small, the latter measured by solving
/// once more with the last factorisation (P. Deuflhard, Newton Methods for Nonlinear Problems, §2.1: the simplified
/// Newton correction bounds the error up to the contraction). An exact guess takes no iteration.
///
/// The linear solver is the chain's own condensation, inside PCSHELL. With the option -windlass_assembled it is the
/// assembled chain.jacobian() in AIJ format and a preconditioner from the options (LU by MUMPS if none is named), so
/// that -pc_type, -ksp_type or -snes_test_jacobian apply.
///
/// Reusable: PETSc's objects are made once per chain size. Not for use from two threads at a time.
class NewtonSolver {
 public:
  NewtonSolver();
  ~NewtonSolver();
  NewtonSolver(NewtonSolver&&) noexcept;
  NewtonSolver& operator=(NewtonSolver&&) noexcept;

  /// @param x  starting state, chain.ambient_size() numbers; the solution on success, untouched otherwise
  /// @return   never throws for want of convergence: a singular matrix or a starting state outside the domain are
  ///           reasons, too
  /// @throws std::invalid_argument if an option or the size of x is wrong; petsc::Error if PETSc fails otherwise
  NewtonResult solve(chain::Chain& chain, Eigen::VectorXd& x, const contact::Loads& loads,
                     const NewtonOptions& options = {});

 private:
  class System;  ///< PETSc's objects and the problem they look at
  std::unique_ptr<System> system_;
};

}  // namespace windlass::equilibrium
