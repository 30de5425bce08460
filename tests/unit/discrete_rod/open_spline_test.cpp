// The spline of a whole rod.
#include "windlass/discrete_rod/open_spline.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace windlass;
using discrete_rod::OpenSpline;
using discrete_rod::SplineRod;

BOOST_AUTO_TEST_SUITE(open_splines)

BOOST_AUTO_TEST_CASE(knots_are_those_of_the_half_on_both_sides) {
  const SplineRod half(9.0, 3.0, 0.25);
  const OpenSpline whole(half);
  const int n = half.elements();
  BOOST_TEST(whole.elements() == 2 * n);
  for (int j = -n; j <= n; ++j) BOOST_TEST(whole.knot(j + n) == half.knot(j));
  for (int e = -n; e < n; ++e) BOOST_TEST(whole.length(e + n) == half.length(e));
}

BOOST_AUTO_TEST_CASE(it_passes_through_the_points_to_fourth_order) {
  // A helix that is not its own half-turn image. On elements of one length: the uniform spline's parameter is arclength.
  const auto helix = [](double s) {
    return OpenSpline::Point(std::sin(s + 0.3), -std::cos(s + 0.3), 0.2 * s + 1.0);
  };
  std::vector<double> errors;
  for (const double h : {0.2, 0.1}) {
    const OpenSpline spline(SplineRod(4.0, 4.0, h));
    std::vector<OpenSpline::Point> points;
    for (int j = 0; j <= spline.elements(); ++j) points.push_back(helix(spline.knot(j)));
    const OpenSpline::Vector x = spline.through(points);
    double error = 0.0;
    for (int e = 3; e + 3 < spline.elements(); ++e)
      error = std::max(
          error, (OpenSpline::position(x, e, 0.4) - helix(spline.knot(e) + 0.4 * spline.length(e))).norm());
    errors.push_back(error);
  }
  const double order = std::log2(errors[0] / errors[1]);
  BOOST_TEST(order > 3.7);
  BOOST_TEST(order < 4.3);
}

BOOST_AUTO_TEST_SUITE_END()
