#include "krylov_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace windlass::stability {

using chain::Variation;
using Eigen::Index;
using Eigen::VectorXd;
using petsc::check;

namespace {

/// Relative to the largest |1/μ|: what is smaller is the rounding of that one, or the infinite μ of a motion without
/// weight.
constexpr double negligible = 1e-13;
/// An eigenvalue 1/μ has, relative to its own size, the rounding of the largest times this at most; where a larger one is
/// in the way it is taken out first.
constexpr double most_dominance = 1e4;

}  // namespace

KrylovSpectrum::KrylovSpectrum(Index points) : points_(points) {
  const PetscInt n = static_cast<PetscInt>(points);
  petsc::ensure_session();
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, operator_.put()));
  check(MatShellSetOperation(operator_, MATOP_MULT, reinterpret_cast<void (*)()>(apply)));
  check(MatSetOption(operator_, MAT_SYMMETRIC, PETSC_TRUE));
  eps_ = solver();
}

petsc::EpsHandle KrylovSpectrum::solver() const {
  petsc::EpsHandle eps;
  check(EPSCreate(PETSC_COMM_SELF, eps.put()));
  check(EPSSetOperators(eps, operator_, nullptr));
  check(EPSSetProblemType(eps, EPS_HEP));
  check(EPSSetType(eps, EPSKRYLOVSCHUR));
  check(EPSSetWhichEigenpairs(eps, EPS_LARGEST_MAGNITUDE));
  // Of the residual: the error of a symmetric problem's eigenvalue is its square.
  check(EPSSetTolerances(eps, 1e-9, 500));
  check(EPSSetFromOptions(eps));
  return eps;
}

PetscErrorCode KrylovSpectrum::apply(Mat shell, Vec in, Vec out) {
  return petsc::guard([&] {
    KrylovSpectrum* self = nullptr;
    check(MatShellGetContext(shell, &self));
    petsc::copy(in, self->in_);
    const Variation& variation = *self->variation_;
    petsc::copy(variation.rotations(variation.solve(variation.loads(self->in_))), out);
  });
}

bool KrylovSpectrum::find(int wanted, std::vector<double>& found, std::vector<petsc::VecHandle>& vectors) {
  // The eigenvalues nearest to zero stand out after the inversion: a few vectors suffice (SLEPc's default of 16 are 16
  // solutions), and where they do not it restarts.
  constexpr int spare = 8;
  const int left =
      static_cast<int>(points_) - static_cast<int>(found.size()) - (variation_->neutral().size() > 0);
  if (left <= 0) return false;
  wanted = std::min(wanted, left);
  // Deflation stays with the solver that it is given to.
  petsc::EpsHandle deflated;
  petsc::VecHandle neutral;
  std::vector<Vec> known(vectors.begin(), vectors.end());
  if (variation_->neutral().size() > 0) {
    neutral = petsc::zero_vector(points_);
    petsc::copy(variation_->neutral(), neutral);
    known.push_back(neutral);
  }
  if (!known.empty()) {
    deflated = solver();
    check(EPSSetDeflationSpace(deflated, static_cast<PetscInt>(known.size()), known.data()));
  }
  const EPS eps = deflated ? deflated.get() : eps_.get();
  check(EPSSetDimensions(eps, wanted, std::min(left, wanted + std::max(spare, wanted)), PETSC_DEFAULT));
  // Always the same random start, not the last point's vectors: a point's spectrum then does not depend, to the last
  // digit, on where a run was resumed; and a vector of one symmetry would not see modes of another.
  BV basis = nullptr;
  PetscRandom random = nullptr;
  check(EPSGetBV(eps, &basis));
  check(BVGetRandomContext(basis, &random));
  check(PetscRandomSetSeed(random, 1));
  check(PetscRandomSeed(random));
  check(EPSSolve(eps));
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  if (converged < wanted)
    throw std::runtime_error("spectrum: only " + std::to_string(converged) + " of " + std::to_string(wanted) +
                             " eigenvalues converged");
  for (PetscInt k = 0; k < converged; ++k) {
    double theta = 0.0;
    petsc::VecHandle vector = petsc::zero_vector(points_);
    check(EPSGetEigenpair(eps, k, &theta, nullptr, vector, nullptr));
    if (std::abs(theta) <= negligible * (found.empty() ? 0.0 : std::abs(found.front()))) return false;
    found.push_back(theta);
    vectors.push_back(std::move(vector));
    // The rest is hidden in this one's rounding: the caller asks for it again.
    if (k + 1 < converged) {
      double next = 0.0;
      check(EPSGetEigenvalue(eps, k + 1, &next, nullptr));
      if (std::abs(theta) > most_dominance * std::abs(next)) break;
    }
  }
  return true;
}

EigenPairs KrylovSpectrum::solve(const Variation& variation, int count, double zero) {
  variation_ = &variation;
  std::vector<double> found;
  std::vector<petsc::VecHandle> vectors;
  const int index = variation.negative();
  int wanted = count + std::max(index, 0);
  const auto missing = [&] {
    const auto negative =
        std::count_if(found.begin(), found.end(), [&](double theta) { return 1.0 / theta <= zero; });
    return std::max(wanted - static_cast<int>(found.size()), index - static_cast<int>(negative));
  };
  for (int more = wanted; more > 0; more = missing())
    if (!find(more, found, vectors)) break;
  EigenPairs out;
  out.inertia_index = index;
  out.values.resize(found.size());
  out.vectors.resize(variation.size(), found.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    petsc::copy(vectors[k], in_);
    out.values(k) = 1.0 / found[k];
    out.vectors.col(k) = variation.solve(variation.loads(in_)) / found[k];
  }
  variation_ = nullptr;
  return out;
}

KrylovSpectrum& KrylovSpectra::of(Index points) {
  for (const auto& solver : solvers_)
    if (solver && solver->points() == points) return *solver;
  auto& replaced = solvers_[next_];
  next_ = (next_ + 1) % solvers_.size();
  replaced = std::make_unique<KrylovSpectrum>(points);
  return *replaced;
}

}  // namespace windlass::stability
