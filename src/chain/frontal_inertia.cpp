#include "windlass/chain/frontal_inertia.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "symmetric_factors.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::chain {

namespace {

using Eigen::Index;
using Entries = Eigen::SparseMatrix<double>;

/// Rows that meet many others (borders): the front holds them to the end.
std::vector<bool> full_rows(const Entries& a) {
  constexpr Index many = 10;  // times the mean
  const Index mean = a.nonZeros() / std::max<Index>(a.cols(), 1);
  std::vector<bool> out;
  for (Index c = 0; c < a.cols(); ++c)
    out.push_back(a.outerIndexPtr()[c + 1] - a.outerIndexPtr()[c] > many * mean);
  return out;
}

/// An order in which unknowns that meet are near each other, full rows last.
std::vector<int> narrow_order(const Entries& a) {
  using petsc::check;
  const std::vector<bool> full = full_rows(a);
  Entries sparse = a;
  sparse.prune([&](Index r, Index c, double) { return r == c || (!full[r] && !full[c]); });
  const petsc::MatHandle matrix = petsc::aij(sparse);
  IS rows = nullptr, columns = nullptr;
  const PetscInt* order = nullptr;
  check(MatGetOrdering(matrix, MATORDERINGRCM, &rows, &columns));
  check(ISGetIndices(rows, &order));
  std::vector<int> out(order, order + a.cols());
  check(ISRestoreIndices(rows, &order));
  check(ISDestroy(&rows));
  check(ISDestroy(&columns));
  std::stable_partition(out.begin(), out.end(), [&](int k) { return !full[k]; });
  return out;
}

/// The unknowns that have been met and are not eliminated, with what is left of their matrix.
class Front {
 public:
  explicit Front(Index unknowns) : place_(unknowns, -1) {}

  void add(int row, int column, double value) {
    const Index r = place(row), c = place(column);
    a_(r, c) += value;
    if (r != c) a_(c, r) += value;
  }
  /// All of an unknown's row is known now.
  void complete(int unknown) { complete_[place(unknown)] = true; }

  void eliminate() {
    bool found = true;
    while (found) {
      found = false;
      for (Index k = 0; k < count_ && !found; ++k) found = complete_[k] && (one(k) || two(k));
    }
  }

  PivotSigns signs() const {
    const SymmetricFactors rest(a_.topLeftCorner(count_, count_));
    return {negative_ + rest.negative(), std::min(least_, rest.least_pivot())};
  }

 private:
  static constexpr double threshold = 0.01;

  Index place(int unknown) {
    if (place_[unknown] >= 0) return place_[unknown];
    if (count_ == a_.rows()) a_.conservativeResize(2 * count_ + 64, 2 * count_ + 64);
    a_.row(count_).head(count_ + 1).setZero();
    a_.col(count_).head(count_ + 1).setZero();
    unknown_.push_back(unknown);
    complete_.push_back(false);
    return place_[unknown] = count_++;
  }

  /// Largest entry of a column but for two rows.
  double largest(Index column, Index but, Index nor) const {
    double out = 0.0;
    for (Index r = 0; r < count_; ++r)
      if (r != but && r != nor) out = std::max(out, std::abs(a_(r, column)));
    return out;
  }

  bool one(Index k) {
    const double pivot = a_(k, k);
    if (pivot == 0.0 || std::abs(pivot) < threshold * largest(k, k, k)) return false;
    const Eigen::VectorXd column = a_.col(k).head(count_);
    auto rest = a_.topLeftCorner(count_, count_);
    rest.noalias() -= column * (column.transpose() / pivot);
    negative_ += pivot < 0.0;
    least_ = std::min(least_, std::abs(pivot));
    remove(k);
    return true;
  }

  bool two(Index k) {
    Index other = -1;
    for (Index r = 0; r < count_; ++r)
      if (r != k && complete_[r] && (other < 0 || std::abs(a_(r, k)) > std::abs(a_(other, k)))) other = r;
    if (other < 0) return false;
    const double p = a_(k, k), q = a_(other, other), b = a_(other, k), det = p * q - b * b;
    const double at_k = largest(k, k, other), at_other = largest(other, k, other);
    const auto grows = [&](double diagonal, double beside, double across) {
      return !(std::abs(det) >= threshold * (std::abs(diagonal) * beside + std::abs(b) * across));
    };
    if (det == 0.0 || grows(q, at_k, at_other) || grows(p, at_other, at_k)) return false;
    const Eigen::VectorXd first = a_.col(k).head(count_), second = a_.col(other).head(count_);
    auto rest = a_.topLeftCorner(count_, count_);
    rest.noalias() -= (first * (q / det) - second * (b / det)) * first.transpose();
    rest.noalias() -= (second * (p / det) - first * (b / det)) * second.transpose();
    negative_ += det < 0.0 ? 1 : p < 0.0 ? 2 : 0;
    least_ = std::min(least_, std::sqrt(std::abs(det)));
    remove(std::max(k, other));
    remove(std::min(k, other));
    return true;
  }

  void remove(Index k) {
    const Index last = --count_;
    place_[unknown_[k]] = -1;
    if (k != last) {
      a_.row(k).head(last + 1) = a_.row(last).head(last + 1).eval();
      a_.col(k).head(last + 1) = a_.col(last).head(last + 1).eval();
      unknown_[k] = unknown_[last], complete_[k] = complete_[last];
      place_[unknown_[k]] = static_cast<int>(k);
    }
    unknown_.pop_back(), complete_.pop_back();
  }

  Eigen::MatrixXd a_;  ///< its corner of `count_` rows, both triangles
  Index count_ = 0;
  std::vector<int> unknown_, place_;
  std::vector<bool> complete_;
  int negative_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

PivotSigns pivot_signs(const Block& symmetric) {
  if (!symmetric.by_columns()) {
    const SymmetricFactors factors(symmetric.whole());
    return {factors.negative(), factors.least_pivot()};
  }
  Entries a;
  symmetric.copy_to(a);
  Front front(a.cols());
  std::vector<bool> done(a.cols(), false);
  for (const int k : narrow_order(a)) {
    for (Entries::InnerIterator at(a, k); at; ++at)
      if (!done[at.row()]) front.add(static_cast<int>(at.row()), k, at.value());
    front.complete(k);
    done[k] = true;
    front.eliminate();
  }
  return front.signs();
}

}  // namespace windlass::chain
