#pragma once

#include "windlass/petsc/handles.hpp"
#include "windlass/pull/dragged_rod.hpp"

namespace windlass::pull {

/// Newton's method of PETSc (SNES, a line search along the residual) for the steps of one rod: exact sparse matrix,
/// factored with pivoting (KLU), since the tensions stand on a block of zeros. PETSc options have the prefix `pull_`.
class StepSolver {
 public:
  using Vector = DraggedRod::Vector;

  explicit StepSolver(const DraggedRod& rod);
  StepSolver(const StepSolver&) = delete;
  StepSolver& operator=(const StepSolver&) = delete;

  /// @param u  a guess; the end of the step if Newton converges, else as it was
  /// @return   iterations, or −1 where Newton does not converge
  int solve(const Memory& last, const Step& step, Vector& u);

 private:
  static PetscErrorCode balance(SNES snes, Vec in, Vec out, void* context);
  static PetscErrorCode linearise(SNES snes, Vec in, Mat matrix, Mat preconditioner, void* context);

  const DraggedRod& rod_;
  const Memory* last_ = nullptr;
  Step step_;
  petsc::SnesHandle snes_;
  petsc::VecHandle solution_, residual_;
  petsc::MatHandle matrix_;
};

}  // namespace windlass::pull
