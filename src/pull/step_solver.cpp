#include "step_solver.hpp"

#include <petscsnes.h>

namespace windlass::pull {

using petsc::check;
using petsc::guard;

PetscErrorCode StepSolver::balance(SNES, Vec in, Vec out, void* context) {
  return guard([&] {
    const auto& self = *static_cast<StepSolver*>(context);
    Vector u, residual;
    petsc::copy(in, u);
    self.rod_.evaluate(u, *self.last_, self.step_, residual, nullptr);
    petsc::copy(residual, out);
  });
}

PetscErrorCode StepSolver::linearise(SNES, Vec in, Mat matrix, Mat, void* context) {
  return guard([&] {
    const auto& self = *static_cast<StepSolver*>(context);
    Vector u, residual;
    petsc::copy(in, u);
    DraggedRod::Sparse jacobian;
    self.rod_.evaluate(u, *self.last_, self.step_, residual, &jacobian);
    check(MatCopy(petsc::aij(jacobian), matrix, SAME_NONZERO_PATTERN));
  });
}

StepSolver::StepSolver(const DraggedRod& rod) : rod_(rod) {
  const Vector u = rod.unknowns(Vector::LinSpaced(rod.spline().size(), 0.0, 1.0));
  const Memory memory = rod.fresh_memory(u);
  Vector residual;
  DraggedRod::Sparse pattern;
  rod.evaluate(u, memory, {}, residual, &pattern);
  matrix_ = petsc::aij(pattern);
  solution_ = petsc::zero_vector(rod.size());
  residual_ = petsc::zero_vector(rod.size());
  check(SNESCreate(PETSC_COMM_SELF, snes_.put()));
  check(SNESSetOptionsPrefix(snes_, "pull_"));
  check(SNESSetType(snes_, SNESNEWTONLS));
  check(SNESSetFunction(snes_, residual_, balance, this));
  check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  constexpr double tolerance = 1e-10;  // of the balance [EI/ρ²]; rounding is 1e-12 of bending stiffnesses 1/h³
  constexpr PetscInt most = 40, unlimited = -1;
  check(SNESSetTolerances(snes_, tolerance, 0.0, 0.0, most, unlimited));
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERKLU));
  check(SNESSetFromOptions(snes_));
}

int StepSolver::solve(const Memory& last, const Step& step, Vector& u) {
  last_ = &last;
  step_ = step;
  petsc::copy(u, solution_);
  check(SNESSolve(snes_, nullptr, solution_));
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(SNESGetConvergedReason(snes_, &reason));
  check(SNESGetIterationNumber(snes_, &iterations));
  if (reason <= 0) return -1;
  petsc::copy(solution_, u);
  return static_cast<int>(iterations);
}

}  // namespace windlass::pull
