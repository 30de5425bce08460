#include "krylov_spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace windlass::stability {

using chain::Variation;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

namespace {

/// Relative to the largest |θ|: what is smaller is that one's rounding, or the infinite μ of a motion without weight.
constexpr double negligible = 1e-13;
/// A θ has the rounding of the largest |θ| in the search. Where that is larger than this times θ, it is taken out first.
constexpr double most_dominance = 1e6;
/// Of the residual, relative to θ: the error of the quotient is its square.
constexpr double tolerance = 1e-7;
/// Of SLEPc.
constexpr PetscInt most_restarts = 500, most_restarts_for_negative = 8;
/// Searches for negative θ. After one that fails `beside` of the positive ones are taken out, and the next has twice the
/// vectors. What it does not find either is next to infinite: that of a contact whose force is the rounding of zero, at an
/// event.
constexpr int most_searches = 2, beside = 5;
/// The order in which negative θ come first. They are often dwarfed by those of small positive μ, of a long rod's twisting:
/// restarts that kept the least θ alone would forget the positive ones, and find them again and again.
constexpr EPSWhich negative_first = EPS_WHICH_USER;

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
  BV basis = nullptr;
  check(EPSGetBV(eps_, &basis));
  check(BVSetType(basis, BVVECS));  // a few short vectors: PETSc's own loops are faster than a BLAS
  check(EPSSetConvergenceTestFunction(eps_, error_of, this, nullptr));
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

/// Negative θ before the others, each by size. What is next to zero has no sign.
PetscErrorCode KrylovSpectrum::prefer_negative(PetscScalar a, PetscScalar, PetscScalar b, PetscScalar,
                                               PetscInt* result, void* context) {
  return petsc::guard([&] {
    double& scale = static_cast<KrylovSpectrum*>(context)->scale_;
    scale = std::max({scale, std::abs(a), std::abs(b)});
    const auto is_negative = [&](double theta) { return theta < -negligible * scale; };
    if (is_negative(a) != is_negative(b))
      *result = is_negative(a) ? -1 : 1;
    else
      *result = std::abs(a) > std::abs(b) ? -1 : std::abs(a) < std::abs(b) ? 1 : 0;
  });
}

PetscErrorCode KrylovSpectrum::error_of(EPS, PetscScalar theta, PetscScalar, PetscReal residual,
                                        PetscReal* error, void* context) {
  const auto& self = *static_cast<const KrylovSpectrum*>(context);
  *error = residual / std::abs(theta);
  // In the search for negative ones the others help, and are no reason to stop.
  constexpr double not_wanted = 1.0;
  if (self.which_ == negative_first && !(theta < -negligible * self.scale_)) *error = not_wanted;
  return 0;
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
  // restarts, which costs as much as two of them on small problems.
  const bool negative = which == negative_first;
  const int spare = negative ? 14 << failed_ : 11;
  wanted = std::min(wanted, left());
  if (wanted <= 0) return false;
  const int most = std::min(left(), wanted + std::max(spare, wanted));
  if (which != which_) {
    check(EPSSetWhichEigenpairs(eps_, which_ = which));
    if (negative) check(EPSSetEigenvalueComparison(eps_, prefer_negative, this));
    check(EPSSetTolerances(eps_, tolerance, negative ? most_restarts_for_negative : most_restarts));
  }
  scale_ = 0.0;
  if (wanted != wanted_ || most != most_)  // each time would set SLEPc up anew
    check(EPSSetDimensions(eps_, wanted_ = wanted, most_ = most, PETSC_DEFAULT));
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
  const bool all = converged >= wanted;
  if (all && variation_->negative() == 0) pairs.resize(wanted);  // others help none of the next searches
  double largest = 0.0;
  for (const Pair& known : found_)
    if (std::isfinite(known.theta)) largest = std::max(largest, std::abs(known.theta));
  for (auto& [theta, y] : pairs) {
    const double size = std::abs(theta);
    if (size <= negligible * largest) return false;
    if (size * most_dominance < std::abs(pairs.front().first)) return true;  // hidden: it is asked for again
    found_.push_back(pair(std::move(y), theta));
  }
  return all;
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
  return static_cast<int>(std::count_if(found_.begin(), found_.end(), [&](const Pair& pair) {
    if (variation_->neutral() && std::abs(pair.value) < neutral_turn)
      return false;  // the inertia leaves it out, too
    if (std::abs(pair.value) < variation_->neutral_size()) return pair.theta < 0.0;
    return pair.theta < 0.0 || pair.value <= pair.rounding;
  }));
}

/// An arc that is nearly singular by itself costs its factors digits, and K⁻¹ with them: 1/θ and the quotient of K itself
/// then differ. The Ritz pairs of K over the vectors found and their corrections K⁻¹(K v − μ M v) are closer by the
/// square of what is wrong with K⁻¹.
void KrylovSpectrum::refine() {
  constexpr double enough = 1e-8;  // a vector as far off has a quotient off by its square
  constexpr int steps = 4;
  const auto exact = [](const Pair& pair) {
    return std::abs(1.0 / pair.theta - pair.value) <= enough * std::abs(pair.value) + pair.rounding;
  };
  if (std::all_of(found_.begin(), found_.end(), exact)) return;
  const auto count = static_cast<Index>(found_.size());
  for (int step = 0; step < steps; ++step) {
    MatrixXd basis(variation_->size(), 2 * count), turned(points_, 2 * count);
    Index columns = 0;
    const auto add = [&](VectorXd v) {
      VectorXd w = variation_->rotations(v);
      const double size = w.norm();
      for (int again = 0; again < 2; ++again) {
        const VectorXd along = turned.leftCols(columns).transpose() * w;
        w -= turned.leftCols(columns) * along;
        v -= basis.leftCols(columns) * along;
      }
      if (!(w.norm() > 1e-10 * size)) return;
      basis.col(columns) = v / w.norm();
      turned.col(columns++) = w / w.norm();
    };
    for (const Pair& pair : found_) add(pair.v);
    for (const Pair& pair : found_)
      add(variation_->solve(variation_->product(pair.v) -
                            pair.value * variation_->loads(variation_->rotations(pair.v))));
    MatrixXd image(variation_->size(), columns);
    for (Index k = 0; k < columns; ++k) image.col(k) = variation_->product(basis.col(k));
    const MatrixXd reduced = basis.leftCols(columns).transpose() * image;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (reduced + reduced.transpose()));
    // Those that are mostly of the vectors found, not of their corrections.
    const VectorXd share = ritz.eigenvectors().topRows(count).colwise().squaredNorm();
    std::vector<Index> order(columns);
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return share(a) > share(b); });
    order.resize(count);
    std::sort(order.begin(), order.end());
    std::sort(found_.begin(), found_.end(), [](const Pair& a, const Pair& b) { return a.value < b.value; });
    bool done = true;
    for (Index k = 0; k < count; ++k) {
      Pair& pair = found_[k];
      pair.v = basis.leftCols(columns) * ritz.eigenvectors().col(order[k]);
      const Variation::Quotient quotient = variation_->quotient(pair.v);
      done = done &&
             std::abs(quotient.value - pair.value) <= enough * std::abs(quotient.value) + quotient.rounding;
      pair.value = quotient.value, pair.rounding = quotient.rounding;
    }
    if (done) return;
  }
}

void KrylovSpectrum::find_negative(int index) {
  for (failed_ = 0; negative() < index;) {
    const std::size_t before = found_.size();
    const bool all = find(negative_first, index - negative());
    const bool hidden =
        std::any_of(found_.begin() + static_cast<long>(before), found_.end(),
                    [&](const Pair& pair) { return std::abs(pair.theta) * most_dominance < scale_; });
    if (hidden) {
      found_.resize(before);
      if (!find(EPS_LARGEST_MAGNITUDE, 1)) return;
    } else if (!all && (++failed_ == most_searches || !find(EPS_LARGEST_MAGNITUDE, beside))) {
      return;  // where the inertia counts more than there are, Spectrum's two counts differ
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
  if (variation.neutral_motion().size() > 0) {  // known; in the operator it would drown all others
    Pair turn;
    turn.v = variation.neutral_motion();
    turn.y = variation.rotations(turn.v);
    turn.v /= turn.y.norm();
    turn.y.normalize();
    turn.theta = std::numeric_limits<double>::infinity();
    const Variation::Quotient quotient = variation.quotient(turn.v);
    turn.value = quotient.value, turn.rounding = quotient.rounding;
    found_.push_back(std::move(turn));
  }
  find_negative(variation.negative());
  find_nearest(count);
  refine();
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
