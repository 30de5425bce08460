#include "windlass/bvp/partial_elimination.hpp"

#include <cmath>

namespace windlass::bvp {

void PartialElimination::resize(int eliminated, int kept) {
  eliminated_ = eliminated;
  kept_ = kept;
  columns_.setZero(eliminated + kept, eliminated);
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

void PartialElimination::reduce(double* f, double* g) const {
  for (int k = 0; k < eliminated_; ++k) {
    const double value = f[k];
    const double* column = columns_.col(k).data();
    for (int i = k + 1; i < eliminated_; ++i) f[i] -= value * column[i];
    for (int i = 0; i < kept_; ++i) g[i] -= value * column[eliminated_ + i];
  }
}

void PartialElimination::expand(double* f, const double* y) const {
  for (int k = eliminated_ - 1; k >= 0; --k) {
    const double* column = columns_.col(k).data();
    double value = f[k] * inverse_pivot_(k);
    for (int i = k + 1; i < eliminated_; ++i) value -= column[i] * f[i];
    for (int i = 0; i < kept_; ++i) value -= column[eliminated_ + i] * y[i];
    f[k] = value;
  }
}

}  // namespace windlass::bvp
