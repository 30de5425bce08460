// The fitted coefficient and its error, on synthetic strengths whose coefficient is known.
#include "windlass/measurement/friction_fit.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"

using namespace windlass;
using measurement::ComparedPoint;
using measurement::fit_friction;
using measurement::FrictionFit;
using measurement::Weights;

namespace {

constexpr double mu = 0.32, two_pi = 2.0 * M_PI;

/// F0 = mu R_tot(T) of the planar 2π capstan at twelve tensions, with errors of deviation `sigma(R_tot)`.
template <class Sigma>
std::vector<ComparedPoint> strengths(std::mt19937& random, const Sigma& sigma, bool tell_errors) {
  std::normal_distribution<double> normal;
  std::vector<ComparedPoint> points;
  for (double T = 1.0; T < 12.0; T *= 1.25) {
    const double R_tot = rod::capstan::total_force(T, two_pi), error = sigma(R_tot);
    ComparedPoint point{{T, mu * R_tot + error * normal(random), {}, 0}, R_tot};
    if (tell_errors) point.measured.F0_error = error;
    points.push_back(point);
  }
  return points;
}

constexpr int repetitions = 2000;

/// Part of many synthetic experiments whose 95 % interval holds the true coefficient.
template <class Sigma>
double coverage(const Sigma& sigma, bool tell_errors, Weights weights) {
  std::mt19937 random(7);
  int held = 0;
  for (int k = 0; k < repetitions; ++k) {
    const FrictionFit fit = fit_friction(strengths(random, sigma, tell_errors), weights);
    held += fit.low <= mu && mu <= fit.high;
  }
  return static_cast<double>(held) / repetitions;
}

// The count of successes in 2000 trials at 95 % has the deviation 0.005: four of them.
constexpr double tolerance = 0.02;

}  // namespace

BOOST_AUTO_TEST_SUITE(friction_fit)

BOOST_AUTO_TEST_CASE(exact_strengths_give_the_exact_coefficient) {
  std::mt19937 random(1);
  for (const Weights weights : {Weights::automatic, Weights::absolute, Weights::relative}) {
    const FrictionFit fit = fit_friction(strengths(
                                             random, [](double) { return 0.0; }, false),
                                         weights);
    BOOST_TEST(fit.mu == mu, boost::test_tools::tolerance(1e-14));  // rounding
    BOOST_TEST(fit.standard_error < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(the_interval_holds_the_coefficient_as_often_as_it_says) {
  const auto constant = [](double) { return 0.4; };
  const auto proportional = [](double R_tot) { return 0.05 * R_tot; };
  BOOST_TEST(std::abs(coverage(constant, false, Weights::absolute) - 0.95) < tolerance);
  BOOST_TEST(std::abs(coverage(proportional, false, Weights::relative) - 0.95) < tolerance);
  BOOST_TEST(std::abs(coverage(proportional, true, Weights::automatic) - 0.95) < tolerance);
}

BOOST_AUTO_TEST_CASE(chi_squared_is_uniform_under_right_errors_and_small_under_wrong_ones) {
  std::mt19937 random(3);
  double mean = 0.0;
  for (int k = 0; k < repetitions; ++k)
    mean += fit_friction(strengths(
                             random, [](double R) { return 0.1 + 0.02 * R; }, true))
                .p_value /
            repetitions;
  BOOST_TEST(std::abs(mean - 0.5) < 4.0 / std::sqrt(12.0 * repetitions));  // four deviations of the mean
  auto points = strengths(
      random, [](double) { return 0.4; }, true);
  for (auto& point : points) point.measured.F0_error = 0.04;
  BOOST_TEST(fit_friction(points).p_value < 1e-6);
}

BOOST_AUTO_TEST_CASE(equal_absolute_errors_let_high_tensions_decide) {
  std::mt19937 random(1);
  auto points = strengths(
      random, [](double) { return 0.0; }, false);
  points.front().measured.F0 *= 2.0;  // a bad point at the lowest tension
  const double absolute = fit_friction(points, Weights::absolute).mu,
               relative = fit_friction(points, Weights::relative).mu;
  double square = 0.0;
  for (const auto& point : points) square += point.R_tot * point.R_tot;
  const double share = points.front().R_tot * points.front().R_tot / square;
  BOOST_TEST(absolute == mu * (1.0 + share), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(relative == mu * (1.0 + 1.0 / static_cast<double>(points.size())),
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(one_point_is_no_fit) {
  const std::vector<ComparedPoint> one{{{1.0, 1.0, {}, 2}, 3.0}};
  BOOST_CHECK_THROW(fit_friction(one), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
