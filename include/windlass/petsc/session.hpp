#pragma once

#include <petscsys.h>

#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// PETSc and SLEPc: their lifetime and their errors, as C++ sees them.
namespace windlass::petsc {

/// A PETSc or SLEPc call failed; `what()` is the message PETSc gave where the error arose.
class Error : public std::runtime_error {
 public:
  Error(PetscErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  PetscErrorCode code() const { return code_; }

 private:
  PetscErrorCode code_;
};

/// Options for PETSc as the user gave them after `--`, e.g. {"-snes_monitor"}.
/// @throws std::logic_error if the session has started already, since PETSc reads them only then.
void set_options(std::span<const std::string> options);

/// Starts MPI, PETSc and SLEPc unless they run; they end with the process.
///
/// Lazy, because it costs some 60 ms that a command without linear algebra need not pay. Every owner of a PETSc
/// handle calls it before creating one; calling it again costs a branch.
/// @throws petsc::Error
void ensure_session();

/// Those of the user's options that nothing has asked for so far, e.g. "-foo_bar": misspelt, or of a solver that did not
/// run. All of them where PETSc was not started.
std::vector<std::string> unused_options();

/// True from the first `ensure_session()` on.
bool session_started();

/// Throws what went wrong in a PETSc call: the C++ exception that left a callback under `guard`, or a
/// petsc::Error. Returns at once for code 0.
void check(PetscErrorCode code);

namespace detail {
void keep_current_exception() noexcept;
}

/// Runs the body of a callback that PETSc calls: an exception may not cross PETSc's C frames, so it is kept, PETSc
/// is told to give up, and the `check` around the outermost PETSc call throws it again.
template <class Body>
PetscErrorCode guard(Body&& body) noexcept {
  try {
    std::forward<Body>(body)();
    return 0;
  } catch (...) {
    detail::keep_current_exception();
    return PETSC_ERR_USER;
  }
}

}  // namespace windlass::petsc
