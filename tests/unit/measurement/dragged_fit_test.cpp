// The coefficient where friction changes the shape: synthetic strengths that are not proportional to it.
#include "windlass/measurement/dragged_fit.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

using namespace windlass;
using measurement::ComparedPoint;
using measurement::Weights;

namespace {

constexpr double true_mu = 0.32;
constexpr double contact_force[] = {2.0, 5.0, 11.0, 23.0};

/// F0 = mu R (1 + mu/2): friction presses the rod on, as the plate does.
std::optional<double> strength(std::size_t point, double friction) {
  return friction * contact_force[point] * (1.0 + 0.5 * friction);
}

std::vector<ComparedPoint> points(double error) {
  std::vector<ComparedPoint> all;
  for (std::size_t i = 0; i < 4; ++i) {
    all.push_back({{1.0 + static_cast<double>(i), *strength(i, true_mu), {}, 0}, contact_force[i]});
    all.back().measured.F0 += i % 2 == 0 ? error : -error;
  }
  return all;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(dragged_fit)

BOOST_AUTO_TEST_CASE(the_coefficient_is_found_from_far_away) {
  for (const double start : {0.01, 0.2, 1.0}) {
    std::vector<ComparedPoint> measured = points(0.0);
    const auto fit = measurement::fit_dragged(measured, Weights::absolute, start, strength);
    BOOST_TEST(std::abs(fit.mu / true_mu - 1.0) < 1e-9);
    for (std::size_t i = 0; i < measured.size(); ++i)
      BOOST_TEST(std::abs(measured[i].R_tot * true_mu - *strength(i, true_mu)) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_least_squares_and_its_error_that_of_the_linearised_problem) {
  std::vector<ComparedPoint> measured = points(0.1);
  const auto fit = measurement::fit_dragged(measured, Weights::absolute, 0.3, strength);
  const auto squares = [&](double at) {
    double sum = 0.0;
    for (std::size_t i = 0; i < measured.size(); ++i)
      sum += std::pow(measured[i].measured.F0 - *strength(i, at), 2);
    return sum;
  };
  BOOST_TEST(fit.chi_squared == squares(fit.mu), boost::test_tools::tolerance(1e-8));
  BOOST_TEST(squares(fit.mu) < squares(fit.mu * 1.001));
  BOOST_TEST(squares(fit.mu) < squares(fit.mu * 0.999));
  double slopes = 0.0;
  for (const double r : contact_force) slopes += std::pow(r * (1.0 + fit.mu), 2);
  BOOST_TEST(fit.standard_error == fit.residual_deviation / std::sqrt(slopes),
             boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(a_state_that_is_lost_is_told) {
  std::vector<ComparedPoint> measured = points(0.0);
  const auto up_to_a_fold = [](std::size_t point, double friction) -> std::optional<double> {
    return friction < 0.25 ? strength(point, friction) : std::nullopt;
  };
  BOOST_CHECK_THROW(measurement::fit_dragged(measured, Weights::absolute, 0.2, up_to_a_fold),
                    std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
