// Special points of a branch found again on another problem.

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/relocated.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

BOOST_AUTO_TEST_SUITE(relocated_points)

// Moved by e in λ and by as much in x: what is left is quadratic in e for a fold, and rounding for a branch point.
constexpr double e = 1e-5;

BOOST_AUTO_TEST_CASE(a_fold) {
  auto moved = scalar([](double x, const Vector& p) { return (x - e) * (x - e) - 2.0 * (p[0] - 0.3 - e); });
  const auto found = relocated(*moved, Options(), vector({0.0}), vector({0.3}), PointType::fold);
  BOOST_REQUIRE(found.has_value());
  BOOST_TEST(std::abs(*found - 0.3 - e) < e * e);
}

BOOST_AUTO_TEST_CASE(a_pitchfork_and_a_transcritical_point) {
  auto pitchfork =
      scalar([](double x, const Vector& p) { return -(p[0] - 0.3 - e) * (x - e) + std::pow(x - e, 3); });
  auto transcritical =
      scalar([](double x, const Vector& p) { return -(p[0] - 0.3 - e) * (x - e) + std::pow(x - e, 2); });
  for (auto& problem : {pitchfork, transcritical}) {
    const auto found = relocated(*problem, Options(), vector({0.0}), vector({0.3}), PointType::branch_point);
    BOOST_REQUIRE(found.has_value());
    BOOST_TEST(std::abs(*found - 0.3 - e) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(a_double_point) {
  auto both = std::make_shared<AlgebraicProblem>(
      2, [](const Vector& x, const Vector& p) { return Vector((0.3 + e - p[0]) * x + x.squaredNorm() * x); });
  const auto found =
      relocated(*both, Options(), vector({0.0, 0.0}), vector({0.3}), PointType::branch_point, 2);
  BOOST_REQUIRE(found.has_value());
  BOOST_TEST(std::abs(*found - 0.3 - e) < 1e-9);
}

BOOST_AUTO_TEST_CASE(nothing_where_there_is_none) {
  auto regular = scalar([](double x, const Vector& p) { return x - p[0]; });
  BOOST_TEST(!relocated(*regular, Options(), vector({0.3}), vector({0.3}), PointType::event));
  BOOST_TEST(!relocated(*regular, Options(), vector({0.3}), vector({0.3}), PointType::branch_point));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
