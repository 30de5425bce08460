#include "windlass/discrete_rod/open_spline.hpp"

namespace windlass::discrete_rod {

OpenSpline::OpenSpline(const SplineRod& half) {
  const int last = half.elements();
  for (int e = -last; e < last; ++e) lengths_.push_back(half.length(e));
  for (int j = -last; j <= last; ++j) knots_.push_back(half.knot(j));
}

OpenSpline::Vector OpenSpline::through(const std::vector<Point>& at_knots) const {
  const int last = elements();
  const auto point = [&](int j) -> Point {  // free ends are straight
    if (j < 0) return 2.0 * at_knots[0] - at_knots[1];
    const auto end = static_cast<std::size_t>(last), here = static_cast<std::size_t>(j);
    return j > last ? Point(2.0 * at_knots[end] - at_knots[end - 1]) : at_knots[here];
  };
  Vector x(size());
  for (int j = -1; j <= last + 1; ++j) {
    // Knot values are (c_{j−1} + 4 c_j + c_{j+1})/6; this is its inverse but for fourth differences.
    Point c = point(j);
    if (j >= 0 && j <= last) c -= (point(j - 1) - 2.0 * point(j) + point(j + 1)) / 6.0;
    x.segment<3>(begin(j + 1)) = c;
  }
  return x;
}

}  // namespace windlass::discrete_rod
