// Tables of Gauss collocation: exactness on polynomials.
#include "windlass/bvp/collocation_table.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

using Eigen::VectorXd;
using windlass::bvp::CollocationTable;

namespace {

constexpr double rounding = 1e-12;  // of sums of some ten terms of size up to M²

VectorXd powers(const VectorXd& points, int degree) {
  return points.unaryExpr([degree](double x) { return std::pow(x, degree); });
}

}  // namespace

BOOST_AUTO_TEST_SUITE(collocation_table)

BOOST_AUTO_TEST_CASE(gauss_weights_integrate_up_to_degree_2m_minus_1_and_no_further) {
  for (int m = windlass::bvp::min_stages; m <= windlass::bvp::max_stages; ++m) {
    const CollocationTable& table = CollocationTable::get(m);
    for (int degree = 0; degree < 2 * m; ++degree)
      BOOST_TEST(std::abs(table.weight.dot(powers(table.gauss, degree)) - 1.0 / (degree + 1)) < rounding);
    // The error at degree 2M is (M!)⁴/((2M)!² (2M+1)), 3e-11 for M = 8.
    BOOST_TEST(std::abs(table.weight.dot(powers(table.gauss, 2 * m)) - 1.0 / (2 * m + 1)) > 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(polynomials_of_degree_m_are_carried_exactly) {
  for (int m = windlass::bvp::min_stages; m <= windlass::bvp::max_stages; ++m) {
    const CollocationTable& table = CollocationTable::get(m);
    BOOST_TEST(table.lobatto(0) == 0.0);
    BOOST_TEST(table.lobatto(m) == 1.0);
    for (int degree = 1; degree <= m; ++degree) {
      const VectorXd nodal = powers(table.lobatto, degree);
      BOOST_TEST((table.value * nodal - powers(table.gauss, degree)).cwiseAbs().maxCoeff() < rounding);
      BOOST_TEST((table.slope * nodal - degree * powers(table.gauss, degree - 1)).cwiseAbs().maxCoeff() <
                 rounding * m * m);
      BOOST_TEST(
          (table.end_slope * nodal - degree * powers(table.lobatto, degree - 1)).cwiseAbs().maxCoeff() <
          rounding * m * m);
      // The integral of its derivative, from values at the Gauss points.
      BOOST_TEST((table.integral * (degree * powers(table.gauss, degree - 1)) - nodal).cwiseAbs().maxCoeff() <
                 rounding * m);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_indicator_is_the_highest_legendre_coefficient) {
  for (int m = windlass::bvp::min_stages; m <= windlass::bvp::max_stages; ++m) {
    const CollocationTable& table = CollocationTable::get(m);
    const VectorXd legendre =
        table.lobatto.unaryExpr([m](double x) { return std::legendre(m, 2.0 * x - 1.0); });
    BOOST_TEST(std::abs(table.highest.dot(legendre) - 1.0) < rounding * m * m);
    for (int degree = 0; degree < m; ++degree)
      BOOST_TEST(std::abs(table.highest.dot(powers(table.lobatto, degree))) < rounding * m * m);
  }
}

BOOST_AUTO_TEST_CASE(numbers_of_stages_out_of_range_are_refused) {
  BOOST_CHECK_THROW(CollocationTable::get(windlass::bvp::min_stages - 1), std::invalid_argument);
  BOOST_CHECK_THROW(CollocationTable::get(windlass::bvp::max_stages + 2), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
