#pragma once

#include "windlass/discrete_rod/spline_rod.hpp"

namespace windlass::discrete_rod {

/// Centre line of a whole rod without any symmetry, a C² curve:
///
///     r(e + t) = Σ_k w_k(t) c_{e+k},   element e from 0 to M − 1, t in [0, 1].
///
/// Unknowns: the control points c_0 .. c_{M+2}, three numbers each, so that those of an element stand together.
/// Rest lengths are those of a `SplineRod` on both sides of the mid-point.
class OpenSpline {
 public:
  using Vector = SplineRod::Vector;
  using Point = SplineRod::Point;
  using Controls = SplineRod::Controls;

  explicit OpenSpline(const SplineRod& half);

  int elements() const { return static_cast<int>(lengths_.size()); }  ///< M, of the whole rod
  Eigen::Index size() const { return 3 * (static_cast<Eigen::Index>(elements()) + 3); }
  double length(int element) const { return lengths_[static_cast<std::size_t>(element)]; }  ///< at rest [ρ]
  double knot(int j) const { return knots_[static_cast<std::size_t>(j)]; }  ///< j in 0 .. M; −L/2 .. L/2 [ρ]

  /// Where the twelve unknowns of an element begin.
  static Eigen::Index begin(int element) { return 3 * static_cast<Eigen::Index>(element); }
  static Controls controls(const Vector& x, int element) {
    return Eigen::Map<const Controls>(x.data() + begin(element));
  }
  static Point position(const Vector& x, int element, double t) {
    return controls(x, element) * cubic_weights(t, 0);
  }

  /// Control points of the curve through points given at knots 0 .. M, to fourth order.
  Vector through(const std::vector<Point>& at_knots) const;

 private:
  std::vector<double> lengths_, knots_;
};

}  // namespace windlass::discrete_rod
