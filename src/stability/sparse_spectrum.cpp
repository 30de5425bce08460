#include "sparse_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace windlass::stability {

using chain::Chain;
using Eigen::Index;
using Eigen::VectorXd;
using petsc::check;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

/// Shifts tried when K is singular to rounding.
constexpr double shifts[] = {0.0, -1e-7, -1e-5, -1e-3};

Sparse zero_like(const Sparse& matrix) {
  Sparse zero = matrix;
  zero.coeffs().setZero();
  return zero;
}

/// At least as many finite eigenvalues there are: unknowns that weigh something, less the constraints.
int finite_eigenvalues(const Chain::SecondVariation& variation) {
  const VectorXd weights = variation.metric.diagonal();
  return static_cast<int>((weights.array() > 0.0).count()) - variation.constraints;
}

std::vector<int> pattern_of(const Chain::SecondVariation& variation) {
  std::vector<int> pattern;
  for (const Sparse* part : {&variation.matrix, &variation.metric}) {
    pattern.insert(pattern.end(), part->outerIndexPtr(), part->outerIndexPtr() + part->outerSize() + 1);
    pattern.insert(pattern.end(), part->innerIndexPtr(), part->innerIndexPtr() + part->nonZeros());
  }
  return pattern;
}

}  // namespace

PatternSpectrum::PatternSpectrum() {
  check(EPSCreate(PETSC_COMM_SELF, eps_.put()));
  check(EPSSetProblemType(eps_, EPS_GHEP));
  check(EPSSetType(eps_, EPSKRYLOVSCHUR));
  check(EPSSetWhichEigenpairs(eps_, EPS_TARGET_MAGNITUDE));
  check(EPSSetTolerances(eps_, 1e-11, 500));
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(EPSGetST(eps_, &st));
  check(STSetType(st, STSINVERT));
  check(STSetMatStructure(st, SUBSET_NONZERO_PATTERN));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(EPSSetFromOptions(eps_));
}

bool PatternSpectrum::fits(const Chain::SecondVariation& variation) const {
  return pattern_ == pattern_of(variation);
}

int PatternSpectrum::negative_pivots() const {
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  Mat factors = nullptr;
  PetscInt negative = 0;
  check(EPSGetST(eps_, &st));
  check(STGetKSP(st, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCFactorGetMatrix(pc, &factors));
  // Zero pivots are not asked for: MUMPS would have to look for null pivots, which perturbs the factors.
  check(MatGetInertia(factors, &negative, nullptr, nullptr));
  return static_cast<int>(negative);
}

int PatternSpectrum::factor(const Chain::SecondVariation& variation) {
  // K takes in M's pattern, so that K − σM has K's.
  petsc::MatHandle matrix = petsc::symmetric(variation.matrix + zero_like(variation.metric));
  petsc::MatHandle metric = petsc::symmetric(variation.metric);
  if (fits(variation)) {
    check(MatCopy(matrix, matrix_, SAME_NONZERO_PATTERN));
    check(MatCopy(metric, metric_, SAME_NONZERO_PATTERN));
  } else {
    matrix_ = std::move(matrix);
    metric_ = std::move(metric);
    pattern_ = pattern_of(variation);
  }
  check(EPSSetOperators(eps_, matrix_, metric_));
  for (const double shift : shifts) {
    shift_ = shift;
    check(EPSSetTarget(eps_, shift));
    try {
      check(EPSSetUp(eps_));
      return negative_pivots();
    } catch (const petsc::Error&) {
      if (shift == shifts[std::size(shifts) - 1]) throw;
    }
  }
  return 0;
}

EigenPairs PatternSpectrum::solve_for(int wanted) {
  // The eigenvalues nearest to zero stand out after the inversion: a few vectors suffice (SLEPc's default of 16 are 16
  // solutions), and where they do not it restarts.
  constexpr int spare = 6;
  check(EPSSetDimensions(eps_, wanted, wanted + std::max(spare, wanted), PETSC_DEFAULT));
  // Always the same random start, so that a point's spectrum does not depend on how many were computed before.
  BV basis = nullptr;
  PetscRandom random = nullptr;
  check(EPSGetBV(eps_, &basis));
  check(BVGetRandomContext(basis, &random));
  check(PetscRandomSetSeed(random, 1));
  check(PetscRandomSeed(random));
  check(EPSSolve(eps_));
  PetscInt converged = 0;
  check(EPSGetConverged(eps_, &converged));
  PetscInt n = 0;
  check(MatGetSize(matrix_, &n, nullptr));
  EigenPairs out;
  out.values.resize(converged);
  out.vectors.resize(n, converged);
  petsc::VecHandle vector = petsc::zero_vector(n);
  VectorXd column;
  for (PetscInt k = 0; k < converged; ++k) {
    check(EPSGetEigenpair(eps_, k, &out.values(k), nullptr, vector, nullptr));
    petsc::copy(vector, column);
    out.vectors.col(k) = column;
  }
  return out;
}

EigenPairs PatternSpectrum::solve(const Chain::SecondVariation& variation, int count) {
  const int index = factor(variation) - variation.constraints;
  const int most = std::max(1, finite_eigenvalues(variation));
  for (int wanted = std::min(count + std::max(index, 0), most);; wanted = std::min(2 * wanted, most)) {
    EigenPairs pairs = solve_for(wanted);
    const int found = static_cast<int>(pairs.values.size());
    if (found < wanted)
      throw std::runtime_error("spectrum: only " + std::to_string(found) + " of " + std::to_string(wanted) +
                               " eigenvalues converged");
    const int below = static_cast<int>((pairs.values.array() < shift_).count());
    if (below < index && wanted < most) continue;
    pairs.shift = shift_;
    pairs.inertia_index = index;
    return pairs;
  }
}

EigenPairs SparseSpectrum::solve(const Chain::SecondVariation& variation, int count) {
  for (const auto& solver : solvers_)
    if (solver && solver->fits(variation)) return solver->solve(variation, count);
  auto& replaced = solvers_[next_];
  next_ = (next_ + 1) % solvers_.size();
  replaced = std::make_unique<PatternSpectrum>();
  return replaced->solve(variation, count);
}

}  // namespace windlass::stability
