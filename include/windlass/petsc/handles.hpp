#pragma once

#include <petscksp.h>
#include <petscmat.h>
#include <petscsnes.h>
#include <petscvec.h>
#include <slepceps.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <utility>

#include "windlass/petsc/session.hpp"

/// Move-only owners of PETSc and SLEPc handles, and the few bridges from Eigen's storage to PETSc's.
namespace windlass::petsc {

/// Owner of one PETSc handle. Null after construction, a move or reset().
///
///     SnesHandle snes;
///     check(SNESCreate(PETSC_COMM_SELF, snes.put()));
///     check(SNESSolve(snes, nullptr, x));
///
/// The raw handle is an implicit conversion away, because every PETSc function wants it. KSP, PC and ST obtained from
/// a SNES or EPS belong to that and need no owner.
template <class Raw, PetscErrorCode (*destroy)(Raw*)>
class Handle {
 public:
  Handle() = default;
  /// Takes over `raw`, which the caller must not destroy any more.
  explicit Handle(Raw raw) : raw_(raw) {}
  Handle(Handle&& other) noexcept : raw_(other.release()) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      raw_ = other.release();
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  Raw get() const { return raw_; }
  operator Raw() const { return raw_; }
  explicit operator bool() const { return raw_ != nullptr; }

  /// Where a PETSc Create function may write; starts PETSc if need be and destroys what was held.
  /// @throws petsc::Error if PETSc cannot be started
  Raw* put() {
    ensure_session();
    reset();
    return &raw_;
  }
  /// Hands the handle to the caller, who destroys it.
  Raw release() noexcept { return std::exchange(raw_, nullptr); }
  /// Destroys the handle. An owner that outlives the session (a static one) drops it: PETSc has freed all by then.
  void reset() noexcept {
    if (raw_ && session_started()) destroy(&raw_);
    raw_ = nullptr;
  }

 private:
  Raw raw_ = nullptr;
};

using MatHandle = Handle<Mat, MatDestroy>;
using VecHandle = Handle<Vec, VecDestroy>;
using SnesHandle = Handle<SNES, SNESDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using EpsHandle = Handle<EPS, EPSDestroy>;
using StHandle = Handle<ST, STDestroy>;

/// Sequential vector of n zeros.
VecHandle zero_vector(Eigen::Index n);

/// Sequential AIJ copy of a sparse matrix, pattern as stored, explicit zeros included.
MatHandle aij(const Eigen::SparseMatrix<double>& matrix);

/// Sequential symmetric (SBAIJ) copy of a symmetric matrix; reads its lower triangle only.
/// Diagonal entries are added where absent: PETSc's symmetric format wants them.
MatHandle symmetric(const Eigen::SparseMatrix<double>& matrix);

/// Copies between Eigen and PETSc; sizes must agree (asserted).
void copy(const Eigen::VectorXd& from, Vec to);
void copy(Vec from, Eigen::VectorXd& to);

}  // namespace windlass::petsc
