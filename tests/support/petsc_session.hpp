#pragma once

#include "windlass/petsc/session.hpp"

namespace windlass::test {

/// Fixture of tests that reach PETSc.
struct PetscSession {
  PetscSession() { petsc::ensure_session(); }
};

}  // namespace windlass::test
