#include "thick_descent.hpp"

#include <petsctao.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "windlass/petsc/handles.hpp"

namespace windlass::discrete_rod {

using Eigen::VectorXd;
using petsc::check;
using petsc::guard;
using Sparse = ThickEnergy::Sparse;

namespace {

using TaoHandle = petsc::Handle<Tao, TaoDestroy>;

/// An energy and the shape that the trust region is about.
struct Descent {
  const ThickEnergy& energy;
  VectorXd from;
};

/// Infinite where strands would pass through each other: a slender rod is less thick than a step is long. The trust region
/// shrinks then.
PetscErrorCode thick_objective(Tao, Vec in, PetscReal* value, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    const auto& descent = *static_cast<Descent*>(context);
    *value = descent.energy.strands_pass(descent.from, x) ? HUGE_VAL : descent.energy.value(x);
  });
}

PetscErrorCode thick_slope(Tao, Vec in, Vec out, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    auto& descent = *static_cast<Descent*>(context);
    petsc::copy(descent.energy.gradient(x), out);
    descent.from = x;
  });
}

/// The Hessian, shifted until it is positive definite.
Sparse convexified(const Sparse& hessian) {
  constexpr double first = 1e-4, factor = 4.0;  // [EI/ρ³]; the last of forty lies far above any stiffness
  Sparse one(hessian.rows(), hessian.cols());
  one.setIdentity();
  Sparse out = hessian;
  double shift = first;
  for (int k = 0; k < 40 && !convex(out); ++k, shift *= factor) out = hessian + shift * one;
  return out;
}

/// Strands that come near each other add entries; those that part leave theirs behind as zeros.
void assign(const Sparse& from, Mat to) {
  check(MatZeroEntries(to));
  check(MatCopy(petsc::aij(from), to, DIFFERENT_NONZERO_PATTERN));
}

petsc::MatHandle growing(const Sparse& matrix) {
  petsc::MatHandle out = petsc::aij(matrix);
  check(MatSetOption(out, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  return out;
}

PetscErrorCode thick_curvature(Tao, Vec in, Mat matrix, Mat preconditioner, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    const Sparse hessian = static_cast<Descent*>(context)->energy.hessian(x);
    assign(hessian, matrix);
    assign(convexified(hessian), preconditioner);
  });
}

}  // namespace

bool convex(const Sparse& hessian) {
  const Eigen::SimplicialLDLT<Sparse> factors(hessian);
  return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0.0;
}

int descend(ThickEnergy& energy, double tolerance, VectorXd& x) {
  const Sparse pattern = energy.hessian(x);
  TaoHandle tao;
  petsc::VecHandle solution = petsc::zero_vector(energy.size());
  petsc::MatHandle matrix = growing(pattern), preconditioner = growing(pattern);
  check(TaoCreate(PETSC_COMM_SELF, tao.put()));
  check(TaoSetOptionsPrefix(tao, "thick_rod_"));
  check(TaoSetType(tao, TAONTR));
  petsc::copy(x, solution);
  check(TaoSetSolution(tao, solution));
  Descent descent{energy, x};
  check(TaoSetObjective(tao, thick_objective, &descent));
  check(TaoSetGradient(tao, nullptr, thick_slope, &descent));
  check(TaoSetHessian(tao, matrix, preconditioner, thick_curvature, &descent));
  check(TaoSetTolerances(tao, tolerance, 0.0, 0.0));
  constexpr int most = 1000;  // slender knots are long on their way
  check(TaoSetMaximumIterations(tao, most));
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(TaoGetKSP(tao, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(TaoSetFromOptions(tao));
  check(TaoSolve(tao));
  TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
  check(TaoGetConvergedReason(tao, &reason));
  PetscInt iterations = 0;
  check(TaoGetIterationNumber(tao, &iterations));
  petsc::copy(solution, x);
  return reason > 0 ? static_cast<int>(iterations) : -1;
}

}  // namespace windlass::discrete_rod
