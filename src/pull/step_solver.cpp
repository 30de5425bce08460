#include "step_solver.hpp"

#include <petscsnes.h>

#include <cmath>
#include <limits>

#include "windlass/petsc/direct_solver.hpp"

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
    const petsc::MatHandle now = petsc::aij(jacobian);
    if (!(self.rod_.setting.radius > 0.0)) {
      check(MatCopy(now, matrix, SAME_NONZERO_PATTERN));
      return;
    }
    check(MatZeroEntries(matrix));  // where strands touch the pattern grows
    check(MatCopy(now, matrix, DIFFERENT_NONZERO_PATTERN));
  });
}

namespace {

/// Of the balance [EI/ρ²]: far below what is measured, above the rounding of places along the rod times the stiffness of
/// an element in bending.
double tolerance_of(const discrete_rod::OpenSpline& spline) {
  constexpr double wanted = 1e-10, margin = 8.0;
  const int last = spline.elements();
  const double shortest = spline.length(last / 2), reach = spline.knot(last);
  return wanted + margin * std::numeric_limits<double>::epsilon() * reach / std::pow(shortest, 3);
}

}  // namespace

StepSolver::StepSolver(const DraggedRod& rod) : rod_(rod) {
  const Vector u = rod.unknowns(Vector::LinSpaced(rod.spline().size(), 0.0, 1.0));
  const Memory memory = rod.fresh_memory(u);
  Vector residual;
  DraggedRod::Sparse pattern;
  rod.evaluate(u, memory, {}, residual, &pattern);
  matrix_ = petsc::aij(pattern);
  check(MatSetOption(matrix_, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  solution_ = petsc::zero_vector(rod.size());
  residual_ = petsc::zero_vector(rod.size());
  check(SNESCreate(PETSC_COMM_SELF, snes_.put()));
  check(SNESSetOptionsPrefix(snes_, "pull_"));
  check(SNESSetType(snes_, SNESNEWTONLS));
  check(SNESSetFunction(snes_, residual_, balance, this));
  check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  constexpr PetscInt most = 40, unlimited = -1;
  check(SNESSetTolerances(snes_, tolerance_of(rod.spline()), 0.0, 0.0, most, unlimited));
  KSP ksp = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  petsc::solve_directly(ksp, MATSOLVERKLU);
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
