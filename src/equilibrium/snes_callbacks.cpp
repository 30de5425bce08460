#include <limits>
#include <sstream>

#include "snes_system.hpp"

/// The callbacks through which SNES sees a bordered system.
namespace windlass::equilibrium {

using Eigen::VectorXd;
using petsc::check;
using petsc::guard;

namespace {

SnesSystem& of(SNES snes) {
  void* context = nullptr;
  check(SNESGetApplicationContext(snes, &context));
  return *static_cast<SnesSystem*>(context);
}

}  // namespace

PetscErrorCode SnesSystem::evaluate(SNES snes, Vec increment, Vec residual, void* context) {
  return guard([&] {
    SnesSystem& self = *static_cast<SnesSystem*>(context);
    self.inside_ = self.reported([&] {
      self.move_to(increment);
      self.defect_ = self.system_->defect();
    });
    if (!self.inside_) return check(SNESSetFunctionDomainError(snes));
    self.work_ = -self.defect_;
    petsc::copy(self.work_, residual);
  });
}

PetscErrorCode SnesSystem::judge(SNES, PetscInt, PetscReal, PetscReal, PetscReal, SNESConvergedReason* reason,
                                 void* context) {
  return guard([&] {
    SnesSystem& self = *static_cast<SnesSystem*>(context);
    *reason = SNES_DIVERGED_INNER;
    self.reported([&] {
      self.find_correction();
      *reason = SNES_CONVERGED_ITERATING;
      if (self.done_) {
        if (!self.report_.factored_here) self.system_->add(self.correction_);
        *reason = SNES_CONVERGED_SNORM_RELATIVE;
      } else if (!self.rule_->settling() && ++self.report_.iterations > self.most_corrections_) {
        std::ostringstream message;
        message << "no convergence in " << self.most_corrections_ << " corrections (increment "
                << self.report_.increment << ", residual " << self.report_.residual << ")";
        self.report_.failure = message.str();
        *reason = SNES_DIVERGED_MAX_IT;
      }
    });
  });
}

PetscErrorCode SnesSystem::absorb(SNES snes, PetscInt) {
  return guard([&] {
    SnesSystem& self = of(snes);
    Vec increment = nullptr;
    check(SNESGetSolution(snes, &increment));
    self.move_to(increment);
    self.base_ = self.iterate_;
    self.increment_.setZero();
    check(VecSet(increment, 0.0));
    // With another convergence test than ours (-snes_convergence_test) no one has asked for it.
    if (self.due_) return;
    if (!self.reported([&] { self.find_correction(); }))
      check(SNESSetConvergedReason(snes, SNES_DIVERGED_INNER));
    ++self.report_.iterations;
  });
}

PetscErrorCode SnesSystem::shorten(SNESLineSearch, Vec, Vec step, PetscBool* changed, void* context) {
  return guard([&] {
    SnesSystem& self = *static_cast<SnesSystem*>(context);
    *changed = PETSC_FALSE;
    if (!self.part_) return;
    petsc::copy(step, self.work_);
    const double part = (*self.part_)(self.iterate_, -self.work_);
    if (part >= 1.0) return;
    check(VecScale(step, part));
    *changed = PETSC_TRUE;
  });
}

PetscErrorCode SnesSystem::apply_inverse(PC pc, Vec right_side, Vec solution) {
  return guard([&] {
    void* context = nullptr;
    check(PCShellGetContext(pc, &context));
    SnesSystem& self = *static_cast<SnesSystem*>(context);
    petsc::copy(right_side, self.work_);
    // Mostly the residual, whose correction is known. Others come from Krylov methods.
    if (self.due_ && self.work_ == -self.defect_) {
      self.work_ = -self.correction_;
    } else if (const VectorXd r = self.work_; !self.reported([&] { self.work_ = self.system_->solve(r); })) {
      self.work_.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    petsc::copy(self.work_, solution);
  });
}

PetscErrorCode SnesSystem::multiply(Mat shell, Vec in, Vec out) {
  return guard([&] {
    void* context = nullptr;
    check(MatShellGetContext(shell, &context));
    SnesSystem& self = *static_cast<SnesSystem*>(context);
    petsc::copy(in, self.work_);
    // A line search asks for J δ, the right-hand side of the correction.
    if (self.due_ && self.work_ == -self.correction_) {
      self.work_ = -self.defect_;
    } else if (self.inside_) {
      const VectorXd v = self.work_;
      self.difference(v, self.work_);
    } else {
      self.work_.setZero();  // SNES asks on giving up whether it stands at a minimum
    }
    petsc::copy(self.work_, out);
  });
}

}  // namespace windlass::equilibrium
