#include "newton_system.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

/// The callbacks through which SNES sees a chain.
namespace windlass::equilibrium {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;
using petsc::guard;

namespace {

constexpr PetscInt no_limit = -1;

PetscErrorCode do_nothing(Mat, MatAssemblyType) { return 0; }

bool option_is_set(const char* name) {
  PetscBool set = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, name, &set));
  return set == PETSC_TRUE;
}

}  // namespace

NewtonSolver::System::System(Eigen::Index size, const NewtonOptions& options)
    : size_(size), options_(options) {
  check(SNESCreate(PETSC_COMM_SELF, snes_.put()));
  increment_vector_ = petsc::zero_vector(size);
  residual_vector_ = petsc::zero_vector(size);
  assembled_ = option_is_set("-windlass_assembled");
  check(SNESSetFunction(snes_, residual_vector_, evaluate, this));
  check(SNESSetApplicationContext(snes_, this));
  check(SNESSetType(snes_, SNESNEWTONLS));
  check(SNESSetUpdate(snes_, absorb));
  check(SNESSetConvergenceTest(snes_, judge, this, nullptr));
  check(SNESSetCheckJacobianDomainError(snes_, PETSC_TRUE));
  check(SNESSetTolerances(snes_, options.residual_tolerance, 0.0, options.increment_tolerance,
                          options.max_iterations, no_limit));
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes_, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBT));
  assembled_ ? choose_lu() : create_matrix();
  check(SNESSetFromOptions(snes_));
  check(SNESGetTolerances(snes_, &residual_tolerance_, nullptr, &increment_tolerance_, nullptr, nullptr));
}

bool NewtonSolver::System::fits(const chain::Chain& chain, const NewtonOptions& options) const {
  // An assembled matrix has the chain's pattern, so it is made anew each time.
  return !assembled_ && chain.size() == size_ && options.residual_tolerance == options_.residual_tolerance &&
         options.increment_tolerance == options_.increment_tolerance &&
         options.max_iterations == options_.max_iterations;
}

void NewtonSolver::System::create_matrix() {
  const PetscInt n = static_cast<PetscInt>(size_);
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, matrix_.put()));
  check(MatShellSetOperation(matrix_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  check(MatShellSetOperation(matrix_, MATOP_ASSEMBLY_END, reinterpret_cast<void (*)()>(do_nothing)));
  check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetContext(pc, this));
  check(PCShellSetApply(pc, apply_inverse));
}

void NewtonSolver::System::choose_lu() {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

void NewtonSolver::System::assemble() {
  const Eigen::SparseMatrix<double> jacobian = chain_->jacobian(base_, *loads_);
  if (!matrix_) {
    matrix_ = petsc::aij(jacobian);
    check(MatSetOption(matrix_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_FALSE));
    check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  } else {
    petsc::MatHandle fresh = petsc::aij(jacobian);
    check(MatCopy(fresh, matrix_, DIFFERENT_NONZERO_PATTERN));
  }
}

PetscErrorCode NewtonSolver::System::evaluate(SNES snes, Vec increment, Vec residual, void* context) {
  return guard([&] {
    System& self = *static_cast<System*>(context);
    petsc::copy(increment, self.trial_increment_);
    const bool at_base = (self.trial_increment_.array() == 0.0).all();
    self.trial_ = at_base ? self.base_ : self.chain_->retract(self.base_, self.trial_increment_);
    try {
      self.value_ = self.chain_->residual(self.trial_, *self.loads_);
      if (!self.value_.allFinite()) throw std::domain_error("the residual is not finite");
      petsc::copy(self.value_, residual);
      self.started_ = true;
    } catch (const std::domain_error&) {
      check(SNESSetFunctionDomainError(snes));
    }
  });
}

PetscErrorCode NewtonSolver::System::absorb(SNES snes, PetscInt) {
  return guard([&] {
    void* context = nullptr;
    Vec increment = nullptr;
    check(SNESGetApplicationContext(snes, &context));
    check(SNESGetSolution(snes, &increment));
    static_cast<System*>(context)->rebase(increment);
  });
}

void NewtonSolver::System::rebase(Vec increment) {
  petsc::copy(increment, delta_);
  const bool evaluated = trial_increment_.size() == delta_.size() && trial_increment_ == delta_;
  base_ = evaluated ? trial_ : chain_->retract(base_, delta_);
  trial_increment_.resize(0);  // it was relative to the old base
  check(VecSet(increment, 0.0));
}

bool NewtonSolver::System::factor() {
  try {
    const MatrixXd none(size_, 0);
    chain_->factor(base_, *loads_, none, none, MatrixXd(0, 0));
    return factored_ = true;
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  } catch (const std::domain_error& error) {
    failure_ = error.what();
  }
  return factored_ = false;
}

PetscErrorCode NewtonSolver::System::linearise(SNES snes, Vec, Mat, Mat, void* context) {
  return guard([&] {
    System& self = *static_cast<System*>(context);
    // The acceptance test measures the increment with the chain's own factors, assembled or not.
    if (!self.factor()) check(SNESSetJacobianDomainError(snes));
    if (self.assembled_) self.assemble();
  });
}

PetscErrorCode NewtonSolver::System::apply_inverse(PC pc, Vec right_side, Vec solution) {
  return guard([&] {
    System* self = nullptr;
    check(PCShellGetContext(pc, &self));
    petsc::copy(right_side, self->solved_for_);
    self->solved_ = self->chain_->solve(self->solved_for_, VectorXd(0));
    petsc::copy(self->solved_, solution);
  });
}

PetscErrorCode NewtonSolver::System::multiply(Mat shell, Vec in, Vec out) {
  return guard([&] {
    System* self = nullptr;
    check(MatShellGetContext(shell, &self));
    VectorXd& v = self->delta_;
    petsc::copy(in, v);
    if (v.size() == self->solved_.size() && v == self->solved_) {
      petsc::copy(self->solved_for_, out);
    } else {
      petsc::copy(self->chain_->jacobian(self->base_, *self->loads_) * v, out);
    }
  });
}

void NewtonSolver::System::measure_increment(const VectorXd& residual) {
  residual_ = residual.size() > 0 ? residual.cwiseAbs().maxCoeff() / scale_ : 0.0;
  solution_ = chain_->solve(residual, VectorXd(0));
  increment_ = solution_.size() > 0 ? solution_.cwiseAbs().maxCoeff() : 0.0;
  if (!std::isfinite(increment_)) increment_ = std::numeric_limits<double>::infinity();
}

bool NewtonSolver::System::measure() {
  petsc::copy(increment_vector_, delta_);
  try {
    measure_increment(chain_->residual(chain_->retract(base_, delta_), *loads_));
  } catch (const std::domain_error&) {
    return false;
  }
  return accepted();
}

bool NewtonSolver::System::accepted() const {
  return residual_ <= residual_tolerance_ && increment_ <= increment_tolerance_;
}

bool NewtonSolver::System::nothing_left() const {
  // A state that hardly resists a motion (a bight whose pulls are parallel to 1e-6, the gap about to open) turns the
  // rounding of the residual into increments far above the tolerance. That rounding is eps times the largest terms that
  // were added up, those of coordinates of size 1: a row of the Jacobian.
  constexpr double visible = 1e-3, additions = 16.0;
  if (increment_ > visible) return false;
  const Eigen::SparseMatrix<double> jacobian = chain_->jacobian(base_, *loads_);
  const double largest = (jacobian.cwiseAbs() * VectorXd::Ones(jacobian.cols())).maxCoeff();
  return residual_ * scale_ <= additions * std::numeric_limits<double>::epsilon() * largest;
}

PetscErrorCode NewtonSolver::System::judge(SNES snes, PetscInt iteration, PetscReal, PetscReal,
                                           PetscReal norm, SNESConvergedReason* reason, void* context) {
  return guard([&] {
    System& self = *static_cast<System*>(context);
    *reason = SNES_CONVERGED_ITERATING;
    if (!std::isfinite(norm)) {
      *reason = SNES_DIVERGED_FNORM_NAN;
      return;
    }
    Vec residual = nullptr;
    check(SNESGetFunction(snes, &residual, nullptr, nullptr));
    petsc::copy(residual, self.value_);
    self.residual_ = self.value_.size() > 0 ? self.value_.cwiseAbs().maxCoeff() / self.scale_ : 0.0;
    if (self.residual_ > self.residual_tolerance_) return;
    if (iteration == 0 && !self.factor()) return;  // the guess may be exact: its own factors tell
    self.measure_increment(self.value_);
    if (self.accepted()) *reason = SNES_CONVERGED_FNORM_ABS;
  });
}

}  // namespace windlass::equilibrium
