#include "dragged_spectrum.hpp"

#include <algorithm>

#include "continuation/eigen_sparse_instances.hpp"
#include "windlass/chain/sparse_factors.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::stability {

using Eigen::VectorXd;
using petsc::check;
using Eigenvalue = std::complex<double>;

namespace {

/// K⁻¹ M as SLEPc's operator.
struct Operator {
  chain::SparseFactors factors;
  const Eigen::SparseMatrix<double>* metric = nullptr;
};

PetscErrorCode apply(Mat shell, Vec in, Vec out) {
  return petsc::guard([&] {
    Operator* op = nullptr;
    check(MatShellGetContext(shell, &op));
    VectorXd x;
    petsc::copy(in, x);
    petsc::copy(VectorXd(op->factors.solve(*op->metric * x, false, false)), out);
  });
}

/// θ of the operator that converged.
std::vector<Eigenvalue> solve(EPS eps, EPSWhich which, int count, PetscInt restarts) {
  constexpr double tolerance = 1e-9;
  check(EPSSetTolerances(eps, tolerance, restarts));
  check(EPSSetWhichEigenpairs(eps, which));
  check(EPSSetDimensions(eps, count, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSolve(eps));
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  std::vector<Eigenvalue> out;
  for (PetscInt k = 0; k < converged; ++k) {
    double real = 0.0, imaginary = 0.0;
    check(EPSGetEigenvalue(eps, k, &real, &imaginary));
    out.emplace_back(real, imaginary);
  }
  return out;
}

}  // namespace

std::vector<Eigenvalue> leading_eigenvalues(const chain::Chain::DraggedVariation& variation, int count) {
  constexpr double negligible = 1e-10, same = 1e-6;
  constexpr int negative = 2;
  // A negative θ stands apart and is found at once. Where there is none the least are those of the multipliers, zero, which
  // are many and would be sought in vain.
  constexpr PetscInt few = 6;
  Operator op;
  op.metric = &variation.metric;
  op.factors.matrix() = variation.matrix;
  if (op.factors.compute() == 0)
    throw std::runtime_error("spectrum: the linearisation of the dragged state is singular");
  const PetscInt n = static_cast<PetscInt>(variation.matrix.rows());
  petsc::MatHandle shell;
  petsc::EpsHandle eps;
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &op, shell.put()));
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(apply)));
  check(EPSCreate(PETSC_COMM_SELF, eps.put()));
  check(EPSSetOperators(eps, shell, nullptr));
  check(EPSSetProblemType(eps, EPS_NHEP));
  check(EPSSetType(eps, EPSKRYLOVSCHUR));
  check(EPSSetFromOptions(eps));
  std::vector<Eigenvalue> thetas = solve(eps, EPS_LARGEST_MAGNITUDE, count, PETSC_DEFAULT);
  // A negative λ far from zero is a θ that is small, but the least.
  for (const Eigenvalue theta : solve(eps, EPS_SMALLEST_REAL, negative, few)) {
    const bool known = std::any_of(thetas.begin(), thetas.end(), [&](Eigenvalue other) {
      return std::abs(theta - other) <= same * std::abs(other);
    });
    if (!known && theta.real() < 0.0) thetas.push_back(theta);
  }
  double largest = 0.0;
  for (const Eigenvalue theta : thetas) largest = std::max(largest, std::abs(theta));
  std::vector<Eigenvalue> out;
  for (const Eigenvalue theta : thetas)
    if (std::abs(theta) > negligible * largest) out.push_back(1.0 / theta);
  std::sort(out.begin(), out.end(), [](Eigenvalue a, Eigenvalue b) { return a.real() < b.real(); });
  return out;
}

}  // namespace windlass::stability
