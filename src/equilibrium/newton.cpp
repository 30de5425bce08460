#include "windlass/equilibrium/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "newton_system.hpp"

namespace windlass::equilibrium {

using petsc::check;

void NewtonOptions::validate() const {
  if (!(residual_tolerance > 0.0)) throw std::invalid_argument("Newton: residual_tolerance must be > 0");
  if (!(increment_tolerance > 0.0)) throw std::invalid_argument("Newton: increment_tolerance must be > 0");
  if (max_iterations < 0) throw std::invalid_argument("Newton: max_iterations must be >= 0");
}

NewtonSolver::NewtonSolver() = default;
NewtonSolver::~NewtonSolver() = default;
NewtonSolver::NewtonSolver(NewtonSolver&&) noexcept = default;
NewtonSolver& NewtonSolver::operator=(NewtonSolver&&) noexcept = default;

NewtonResult NewtonSolver::solve(chain::Chain& chain, Eigen::VectorXd& x, const contact::Loads& loads,
                                 const NewtonOptions& options) {
  options.validate();
  if (x.size() != chain.ambient_size())
    throw std::invalid_argument("Newton: the state does not fit the chain");
  if (!system_ || !system_->fits(chain, options)) system_ = std::make_unique<System>(chain.size(), options);
  try {
    return system_->solve(chain, x, loads);
  } catch (...) {
    system_.reset();  // PETSc's objects may be left locked in the middle of a solve
    throw;
  }
}

NewtonResult NewtonSolver::System::solve(chain::Chain& chain, Eigen::VectorXd& x,
                                         const contact::Loads& loads) {
  chain_ = &chain;
  loads_ = &loads;
  base_ = x;
  trial_increment_.resize(0);
  solved_.resize(0);
  scale_ = std::max({1.0, std::abs(loads.tension), std::abs(loads.thrust)});
  factored_ = started_ = false;
  residual_ = increment_ = std::numeric_limits<double>::infinity();
  check(VecSet(increment_vector_, 0.0));
  if (assembled_) assemble();
  check(SNESSolve(snes_, nullptr, increment_vector_));

  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(SNESGetConvergedReason(snes_, &reason));
  check(SNESGetIterationNumber(snes_, &iterations));
  // Near rounding the line search may find no decrease any more; the state is judged, not the reason.
  const bool at_rounding = reason < 0 && started_ && factored_ && (measure() || nothing_left());
  NewtonResult result;
  result.converged = reason > 0 ? accepted() : at_rounding;
  result.iterations = static_cast<int>(iterations);
  result.residual = residual_;
  result.increment = increment_;
  const char* text = nullptr;
  check(SNESGetConvergedReasonString(snes_, &text));
  result.reason = at_rounding ? "CONVERGED_ROUNDING" : failure_.empty() ? text : text + (": " + failure_);
  if (result.converged) {
    rebase(increment_vector_);
    x = base_;
  }
  failure_.clear();
  return result;
}

}  // namespace windlass::equilibrium
