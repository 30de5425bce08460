#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace windlass::discrete_rod {

/// Uniform cubic B-splines on one element: values or derivatives of the four that do not vanish there.
using Weights = Eigen::Vector4d;

/// @param t      place in the element, in [0, 1]
/// @param order  of the derivative with respect to t: 0, 1 or 2
Weights cubic_weights(double t, int order);

/// Centre line of a rod that is its own image under the half-turn (x, y, z)(−s) = (−x, y, −z)(s), a C² curve:
///
///     r(e + t) = Σ_k w_k(t) c_{e−1+k},   element e from −N to N − 1, t in [0, 1].
///
/// Control points c_j with j < 0 are the images of c_{−j}; c_0 = (0, y, 0). Unknowns: y_0, then
/// c_1 .. c_{N+1}. Elements have rest lengths h near the coil and longer ones along the tails, graded by one
/// function of s for all h.
class SplineRod {
 public:
  using Vector = Eigen::VectorXd;
  using Point = Eigen::Vector3d;
  using Controls = Eigen::Matrix<double, 3, 4>;  ///< of one element

  /// @param half_length  of the half rod [ρ]
  /// @param fine_length  from the mid-point on, of elements of length h [ρ]
  SplineRod(double half_length, double fine_length, double h);

  int elements() const { return static_cast<int>(lengths_.size()); }  ///< N, of the half rod
  Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(elements()) + 4; }
  double length(int element) const { return lengths_[element < 0 ? -element - 1 : element]; }
  double knot(int j) const { return j < 0 ? -knots_[-j] : knots_[j]; }  ///< arclength at rest [ρ]

  /// Where coordinate `c` of control point j stands among the unknowns (−1: held at zero), and its sign.
  struct Place {
    Eigen::Index index;
    double sign;
  };
  static Place place(int j, int c);

  Controls controls(const Vector& x, int element) const;
  Point position(const Vector& x, int element, double t) const {
    return controls(x, element) * cubic_weights(t, 0);
  }

  /// Control points of the curve through points given at knots 0 .. N, to fourth order.
  Vector through(const std::vector<Point>& at_knots) const;

 private:
  std::vector<double> lengths_, knots_;
};

}  // namespace windlass::discrete_rod
