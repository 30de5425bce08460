#pragma once

#include "windlass/petsc/handles.hpp"

namespace windlass::petsc {

/// Lets linear systems be solved by LU alone, without iterations.
/// @param package  whose factors, e.g. MATSOLVERKLU; null: PETSc's own
inline void solve_directly(KSP ksp, MatSolverType package = nullptr) {
  PC pc = nullptr;
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  if (package) check(PCFactorSetMatSolverType(pc, package));
}

}  // namespace windlass::petsc
