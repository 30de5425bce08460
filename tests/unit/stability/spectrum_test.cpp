#include "windlass/stability/spectrum.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "unit/equilibrium/coil.hpp"
#include "windlass/equilibrium/newton.hpp"

using namespace windlass;
using chain::Chain;
using contact::Parity;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using stability::Spectrum;
using stability::SpectrumSolver;

BOOST_AUTO_TEST_SUITE(spectrum)

namespace {

constexpr double pi = std::numbers::pi;

/// A planar rod of length 2 along its own pull: ∫ δθ'² + T δθ² ds, in compression for T < 0.
struct Strut {
  Chain chain;
  VectorXd x;
  contact::Loads loads;
};

Strut strut(double tension, bool clamped, int elements, int stages = 6) {
  std::vector<std::unique_ptr<contact::Joint>> joints;
  joints.push_back(std::make_unique<contact::planar::End>(contact::Side::right, clamped));
  joints.push_back(std::make_unique<contact::planar::End>(contact::Side::left, clamped));
  std::vector<chain::Link> links;
  links.push_back(
      {bvp::make_collocation_arc(rod::PlanarDensity{}, test::graded(elements, 1.0), stages), "tail", 1});
  contact::Loads loads;
  loads.tension = tension;
  loads.half_length = 1.0;
  Strut out{Chain(std::move(joints), {-1.0, 1.0}, std::move(links), {}), {}, loads};
  out.x = VectorXd::Zero(out.chain.ambient_size());
  return out;
}

test::Coil equilibrium_coil(double tension) {
  test::Coil coil = test::spatial_coil(tension);
  BOOST_TEST_REQUIRE(equilibrium::NewtonSolver().solve(coil.chain, coil.x, coil.loads).converged);
  const MatrixXd none(coil.chain.size(), 0);
  coil.chain.factor(coil.x, coil.loads, none, none, MatrixXd(0, 0));
  return coil;
}

void check_pairs(const Chain::SecondVariation& variation, const Spectrum& spectrum) {
  BOOST_TEST(spectrum.agrees());
  BOOST_TEST(spectrum.residual < 1e-8);
  const MatrixXd& v = spectrum.eigenvectors;
  const MatrixXd gram = v.transpose() * (variation.metric * v);
  BOOST_TEST_INFO("residual " << spectrum.residual);
  BOOST_TEST((gram - MatrixXd::Identity(v.cols(), v.cols())).cwiseAbs().maxCoeff() < 1e-6);
  for (Eigen::Index k = 1; k < spectrum.eigenvalues.size(); ++k)
    BOOST_TEST(spectrum.eigenvalues(k - 1) <= spectrum.eigenvalues(k));
}

}  // namespace

BOOST_AUTO_TEST_CASE(clamped_strut_has_eulers_loads) {
  // μ_k = (kπ/L)² + T, L = 2: at T = −20 the loads of k = 1, 2 are passed, 2.47 and 9.87, and that of 3, 22.2, is not.
  for (const int elements : {4, 10}) {  // the dense and the sparse solver
    const Strut rod = strut(-20.0, true, elements);
    const auto variation = rod.chain.second_variation(rod.x, rod.loads, Parity::even);
    const Spectrum spectrum = stability::lowest(variation, 4);
    check_pairs(variation, spectrum);
    BOOST_TEST(spectrum.index == 2);
    BOOST_TEST_REQUIRE(spectrum.eigenvalues.size() == 4);
    for (int k = 1; k <= 4; ++k)
      BOOST_TEST(spectrum.eigenvalues(k - 1) == 0.25 * k * k * pi * pi - 20.0,
                 boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(free_straight_rod_under_tension) {
  const Strut rod = strut(3.0, false, 12);
  const auto variation = rod.chain.second_variation(rod.x, rod.loads, Parity::even);
  const Spectrum spectrum = stability::lowest(variation, 3);
  check_pairs(variation, spectrum);
  BOOST_TEST(spectrum.index == 0);
  for (int k = 0; k < 3; ++k)
    BOOST_TEST(spectrum.eigenvalues(k) == 0.25 * k * k * pi * pi + 3.0, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(all_negative_eigenvalues_come_along) {
  const Strut rod = strut(-130.0, true, 12);  // k = 1 … 7: (7π/2)² = 120.9, (8π/2)² = 157.9
  const Spectrum spectrum = stability::lowest(rod.chain.second_variation(rod.x, rod.loads, Parity::even), 1);
  BOOST_TEST(spectrum.index == 7);
  BOOST_TEST(spectrum.inertia_index == 7);
  BOOST_TEST(spectrum.eigenvalues.size() == 7);
}

BOOST_AUTO_TEST_CASE(a_singular_matrix_is_no_failure) {
  for (const int elements : {4, 10}) {
    const Strut rod = strut(-0.25 * pi * pi, true, elements);
    const Spectrum spectrum =
        stability::lowest(rod.chain.second_variation(rod.x, rod.loads, Parity::even), 2);
    BOOST_TEST(std::abs(spectrum.eigenvalues(0)) < 1e-9);
    BOOST_TEST(spectrum.eigenvalues(1) == 0.75 * pi * pi, boost::test_tools::tolerance(1e-8));
  }
}

BOOST_AUTO_TEST_CASE(the_coil_loses_even_stability_between_1_4_and_1_2) {
  SpectrumSolver solver;
  for (const double tension : {1.4, 1.2, 1.0, 0.6}) {
    test::Coil coil = equilibrium_coil(tension);
    for (const Parity parity : {Parity::even, Parity::odd}) {
      const auto variation = coil.chain.second_variation(coil.x, coil.loads, parity);
      const Spectrum spectrum = solver.lowest(variation, 3);
      BOOST_TEST_MESSAGE("T " << tension << (parity == Parity::even ? " even " : " odd ")
                              << spectrum.eigenvalues.transpose() << "  residual " << spectrum.residual);
      check_pairs(variation, spectrum);
      BOOST_TEST(spectrum.index == coil.chain.index(coil.x, coil.loads, parity));
      if (parity == Parity::even && tension == 1.4) BOOST_TEST(spectrum.eigenvalues(0) > 0.0);
      if (parity == Parity::even && tension == 1.2) BOOST_TEST(spectrum.eigenvalues(0) < 0.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(no_configuration_no_eigenvalues) {
  Chain::SecondVariation variation;  // a multiplier and the coordinate it holds
  variation.matrix = MatrixXd{{0.0, 1.0}, {1.0, 2.0}}.sparseView();
  variation.metric.resize(2, 2);
  variation.constraints = 1;
  const Spectrum spectrum = stability::lowest(variation, 3);
  BOOST_TEST(spectrum.eigenvalues.size() == 0);
  BOOST_TEST(spectrum.index == 0);
  BOOST_TEST(spectrum.agrees());
}

BOOST_AUTO_TEST_CASE(wrong_arguments_are_named) {
  const Strut rod = strut(1.0, true, 3);
  auto variation = rod.chain.second_variation(rod.x, rod.loads, Parity::even);
  BOOST_CHECK_THROW(stability::lowest(variation, 0), std::invalid_argument);
  variation.metric.resize(2, 2);
  BOOST_CHECK_THROW(stability::lowest(variation, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
