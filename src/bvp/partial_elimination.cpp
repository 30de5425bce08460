#include "windlass/bvp/partial_elimination.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace windlass::bvp {

namespace {

constexpr int width = 4;  ///< numbers that are worked on at once
using Pack = Eigen::Array<double, width, 1>;
/// Eigen's own alignment of the columns: 16 bytes for SSE, 32 for AVX.
constexpr int aligned = std::min(EIGEN_DEFAULT_ALIGN_BYTES, 32);

/// f and g in one column, padded as those of the factors are.
struct Padded {
  static constexpr int most = 64;
  alignas(32) std::array<double, most> values;

  Padded(const double* f, int eliminated, const double* g, int kept) {
    std::copy_n(f, eliminated, values.begin());
    std::copy_n(g, kept, values.begin() + eliminated);
    std::fill_n(values.begin() + eliminated + kept, width - 1, 0.0);
  }
  auto pack(int i) { return Eigen::Map<Pack, aligned>(&values[i]); }
};

auto pack(const double* column, int i) { return Eigen::Map<const Pack, aligned>(column + i); }

}  // namespace

void PartialElimination::resize(int eliminated, int kept) {
  eliminated_ = eliminated;
  kept_ = kept;
  const auto padded = [](int count) { return (count + width - 1) / width * width; };
  assert(padded(eliminated + kept) <= Padded::most);
  columns_.setZero(padded(eliminated + kept), padded(eliminated));
  inverse_pivot_.setZero(eliminated);
}

void PartialElimination::factor(Eigen::MatrixXd& full) {
  // Plain loops: the matrices have 10 to 35 rows, where the overhead of library kernels exceeds the work.
  const int size = eliminated_ + kept_;
  negative_ = 0;
  for (int k = 0; k < eliminated_; ++k) {
    const double* source = full.col(k).data();
    double* column = columns_.col(k).data();
    double scale = 1e-300;
    for (int i = k; i < size; ++i) scale = std::max(scale, std::abs(source[i]));
    double pivot = source[k];
    if (std::abs(pivot) < pivot_floor * scale) pivot = std::copysign(pivot_floor * scale, pivot);
    if (pivot < 0.0) ++negative_;
    const double inverse = 1.0 / pivot;
    inverse_pivot_(k) = inverse;
    for (int i = k + 1; i < size; ++i) column[i] = source[i] * inverse;
    for (int j = k + 1; j < size; ++j) {
      const double factor = source[j];
      double* target = full.col(j).data();
      for (int i = j; i < size; ++i) target[i] -= factor * column[i];
    }
  }
}

// Starts at a whole pack: what a column holds above its diagonal is zero, and so is what lies beyond its end.
void PartialElimination::reduce(double* f, double* g) const {
  Padded v(f, eliminated_, g, kept_);
  const int size = eliminated_ + kept_;
  for (int k = 0; k < eliminated_; ++k) {
    const double value = v.values[k];
    const double* column = columns_.col(k).data();
    for (int i = (k + 1) / width * width; i < size; i += width) v.pack(i) -= value * pack(column, i);
  }
  std::copy_n(v.values.begin(), eliminated_, f);
  std::copy_n(v.values.begin() + eliminated_, kept_, g);
}

// By blocks of as many unknowns as a pack holds, so that no pack is read right after one of its numbers was written: the
// processor would wait for it. Columns that there are not are zero.
void PartialElimination::expand(double* f, const double* y) const {
  Padded v(f, eliminated_, y, kept_);
  const int last = static_cast<int>(columns_.rows()) - width;
  for (int first = (eliminated_ - 1) / width * width; first >= 0; first -= width) {
    std::array<Pack, width> sums;
    for (Pack& sum : sums) sum.setZero();
    for (int i = last; i > first; i -= width)  // what was written last comes last
      for (int c = 0; c < width; ++c) sums[c] += v.pack(i) * pack(columns_.col(first + c).data(), i);
    std::array<double, width> own;
    std::copy_n(&v.values[first], width, own.begin());
    for (int c = std::min(width, eliminated_ - first) - 1; c >= 0; --c) {
      own[c] = own[c] * inverse_pivot_(first + c) - sums[c].sum();
      for (int r = c + 1; r < width; ++r) own[c] -= columns_(first + r, first + c) * own[r];
    }
    std::copy_n(own.begin(), width, &v.values[first]);
  }
  std::copy_n(v.values.begin(), eliminated_, f);
}

}  // namespace windlass::bvp
