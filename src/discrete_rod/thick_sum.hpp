#pragma once

#include <initializer_list>
#include <vector>

#include "windlass/discrete_rod/thick_energy.hpp"

namespace windlass::discrete_rod {

struct ThickEnergy::Sum {
  double value = 0.0;
  bool derivatives = false;
  Vector gradient;
  std::vector<Eigen::Triplet<double>> entries;
};

/// Derivatives of a function of the control points of some elements, taken home to the unknowns.
struct ThickEnergy::Local {
  std::vector<SplineRod::Place> places;
  explicit Local(std::initializer_list<int> elements) {
    for (const int e : elements)
      for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c) places.push_back(SplineRod::place(e - 1 + k, c));
  }
  template <class Gradient, class Hessian>
  void add(const Gradient& gradient, const Hessian& hessian, Sum& sum) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [row, sign] = places[i];
      if (row < 0) continue;
      const Eigen::Index a = static_cast<Eigen::Index>(i);
      sum.gradient(row) += sign * gradient(a);
      for (std::size_t j = 0; j < places.size(); ++j)
        if (const auto [column, other] = places[j]; column >= 0)
          sum.entries.emplace_back(row, column, sign * other * hessian(a, static_cast<Eigen::Index>(j)));
    }
  }
};

/// A vector of the curve (order: 0 place, 1 and 2 its derivatives by t) by the control points of its element.
using Shape = Eigen::Matrix<double, 3, 12>;
inline Shape shape(double t, int order) {
  const Weights w = cubic_weights(t, order);
  Shape out = Shape::Zero();
  for (int k = 0; k < 4; ++k) out.middleCols<3>(3 * k) = w(k) * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace windlass::discrete_rod
