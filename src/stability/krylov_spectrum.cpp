#include "krylov_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace windlass::stability {

using chain::Variation;
using Eigen::Index;
using Eigen::VectorXd;
using petsc::check;

namespace {

/// Relative to the largest |θ|: what is smaller is that one's rounding, or the infinite μ of a motion without weight.
constexpr double negligible = 1e-13;
/// A θ has the rounding of the largest |θ| in the search. Where that is larger than this times θ, it is taken out first.
constexpr double most_dominance = 1e6;
/// Of the residual, relative to θ: the error of the quotient is its square.
constexpr double tolerance = 1e-8;

}  // namespace

KrylovSpectrum::KrylovSpectrum(Index points) : points_(points) {
  const PetscInt n = static_cast<PetscInt>(points);
  vector_ = petsc::zero_vector(points);
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, operator_.put()));
  check(MatShellSetOperation(operator_, MATOP_MULT, reinterpret_cast<void (*)()>(apply)));
  check(MatSetOption(operator_, MAT_SYMMETRIC, PETSC_TRUE));
  check(EPSCreate(PETSC_COMM_SELF, eps_.put()));
  check(EPSSetOperators(eps_, operator_, nullptr));
  check(EPSSetProblemType(eps_, EPS_HEP));
  check(EPSSetType(eps_, EPSKRYLOVSCHUR));
  check(EPSSetTolerances(eps_, tolerance, 500));
  check(EPSSetFromOptions(eps_));
}

PetscErrorCode KrylovSpectrum::apply(Mat shell, Vec in, Vec out) {
  return petsc::guard([&] {
    KrylovSpectrum* self = nullptr;
    check(MatShellGetContext(shell, &self));
    const PetscScalar* given = nullptr;
    PetscScalar* result = nullptr;
    check(VecGetArrayRead(in, &given));
    const Eigen::Map<const VectorXd> y(given, self->points_);
    const Variation& variation = *self->variation_;
    VectorXd image = variation.rotations(variation.solve(variation.loads(y)));
    check(VecRestoreArrayRead(in, &given));
    self->project_out(image);
    check(VecGetArrayWrite(out, &result));
    Eigen::Map<VectorXd>(result, self->points_) = image;
    check(VecRestoreArrayWrite(out, &result));
  });
}

void KrylovSpectrum::project_out(Eigen::Ref<VectorXd> y) const {
  for (const Pair& known : found_) y -= known.y.dot(y) * known.y;
}

Pair KrylovSpectrum::pair(VectorXd y, double theta) const {
  Pair out;
  out.v = variation_->solve(variation_->loads(y)) / theta;
  out.y = std::move(y);
  out.theta = theta;
  const Variation::Quotient quotient = variation_->quotient(out.v);
  out.value = quotient.value;
  out.rounding = quotient.rounding;
  return out;
}

bool KrylovSpectrum::find(EPSWhich which, int wanted) {
  // The extreme θ stand out: a few vectors suffice (SLEPc's default of 16 are 16 solutions), and where they do not it
  // restarts.
  constexpr int spare = 7;
  wanted = std::min(wanted, left());
  if (wanted <= 0) return false;
  check(EPSSetWhichEigenpairs(eps_, which));
  check(EPSSetDimensions(eps_, wanted, std::min(left(), wanted + std::max(spare, wanted)), PETSC_DEFAULT));
  petsc::copy(start(), vector_);
  Vec raw = vector_;
  check(EPSSetInitialSpace(eps_, 1, &raw));
  check(EPSSolve(eps_));
  PetscInt converged = 0;
  check(EPSGetConverged(eps_, &converged));
  std::vector<std::pair<double, VectorXd>> pairs(converged);
  for (PetscInt k = 0; k < converged; ++k) {
    check(EPSGetEigenpair(eps_, k, &pairs[k].first, nullptr, vector_, nullptr));
    petsc::copy(vector_, pairs[k].second);
  }
  const double largest = found_.empty() ? 0.0 : std::abs(found_.front().theta);
  for (auto& [theta, y] : pairs) {
    const double size = std::abs(theta);
    if (size <= negligible * largest) return false;
    if (size * most_dominance < std::abs(pairs.front().first)) return true;  // hidden: it is asked for again
    if (which == EPS_LARGEST_MAGNITUDE) bound_ = size;
    found_.push_back(pair(std::move(y), theta));
  }
  return converged >= wanted;
}

/// Another vector each time, without the pairs found; the same ones at every point, so that a point's spectrum does not
/// depend, to the last digit, on where a run was resumed.
VectorXd KrylovSpectrum::start() {
  std::minstd_rand random(++starts_);
  random.discard(1);  // the first number is nearly proportional to the seed
  VectorXd out(points_);
  for (double& value : out) value = static_cast<double>(random()) / std::minstd_rand::max() - 0.5;
  project_out(out);
  return out;
}

int KrylovSpectrum::negative() const {
  return static_cast<int>(std::count_if(found_.begin(), found_.end(),
                                        [](const Pair& pair) { return pair.value <= pair.rounding; }));
}

void KrylovSpectrum::find_negative(int index) {
  while (negative() < index) {
    const std::size_t before = found_.size();
    const bool all = find(EPS_SMALLEST_REAL, index - negative());
    const bool hidden = std::any_of(found_.begin() + static_cast<long>(before), found_.end(), [&](const Pair& pair) {
      return std::abs(pair.theta) * most_dominance < bound_;
    });
    if (hidden) {
      found_.resize(before);
      if (!find(EPS_LARGEST_MAGNITUDE, 1)) return;
    } else if (!all) {
      return;  // the inertia counts more than there are: Spectrum::agrees() says so
    }
  }
}

void KrylovSpectrum::find_nearest(int count) {
  while (static_cast<int>(found_.size()) < count)
    if (!find(EPS_LARGEST_MAGNITUDE, count - static_cast<int>(found_.size()))) break;
  if (count == 1) return;
  // Krylov spaces hold one vector of a multiple eigenvalue: another start shows whether a copy is left.
  const auto last = [&] {
    double least = std::numeric_limits<double>::infinity();
    for (const Pair& pair : found_)
      if (pair.theta > 0.0) least = std::min(least, pair.theta);
    return least;
  };
  for (double least = last(); find(EPS_LARGEST_MAGNITUDE, 1) && found_.back().theta > least; least = last()) {
  }
}

std::vector<Pair> KrylovSpectrum::solve(const Variation& variation, int count) {
  variation_ = &variation;
  found_.clear();
  starts_ = 0;
  if (find(EPS_LARGEST_MAGNITUDE, 1)) {
    find_negative(variation.negative());
    find_nearest(count);
  }
  variation_ = nullptr;
  return std::move(found_);
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
