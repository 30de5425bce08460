#pragma once

#include <Eigen/Core>
#include <cmath>

namespace windlass::rod {

/// A number with its derivatives with N variables: forward differentiation of formulas as they are written.
template <int N>
struct Dual {
  using Slopes = Eigen::Matrix<double, N, 1>;
  double value = 0.0;
  Slopes by = Slopes::Zero();

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: numbers mix with constants
  Dual(double v, const Slopes& slopes) : value(v), by(slopes) {}
  static Dual variable(double v, int k) { return {v, Slopes::Unit(k)}; }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.by + b.by}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.by - b.by}; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.by}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.by * b.value + b.by * a.value};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double ratio = a.value / b.value;
    return {ratio, (a.by - ratio * b.by) / b.value};
  }
  friend Dual sin(const Dual& a) { return {std::sin(a.value), std::cos(a.value) * a.by}; }
  friend Dual cos(const Dual& a) { return {std::cos(a.value), -std::sin(a.value) * a.by}; }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return {root, a.by / (2.0 * root)};
  }
};

}  // namespace windlass::rod
