#pragma once

#include <vector>

#include "windlass/discrete_rod/open_spline.hpp"
#include "windlass/discrete_rod/spline_rod.hpp"

namespace windlass::discrete_rod {

/// A place of the rod and a nearest place of another strand: a minimum of the distance over the second alone.
struct StrandPair {
  int element, other;  ///< of the first place and of the second
  double t, other_t;   ///< within their elements
  double weight;       ///< length of rod the first place stands for [ρ]
  double distance;     ///< [ρ]
};

/// Gauss points of one element, on [0, 1].
struct Quadrature {
  static constexpr int points = 4;
  static const std::array<double, points> place, weight;
};

/// All pairs closer than `reach` whose first place is a Gauss point of the half s >= 0; the second lies
/// anywhere on the rod, more than `apart` of arclength away. Candidates come from a list of cells, so that
/// work grows with the length.
std::vector<StrandPair> strand_pairs(const SplineRod& rod, const SplineRod::Vector& x, double reach,
                                     double apart);

/// The same of a whole rod without symmetry: the first place is any Gauss point.
std::vector<StrandPair> strand_pairs(const OpenSpline& rod, const OpenSpline::Vector& x, double reach,
                                     double apart);

}  // namespace windlass::discrete_rod
