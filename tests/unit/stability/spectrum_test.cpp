#include "windlass/stability/spectrum.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "unit/equilibrium/chain_problem.hpp"
#include "unit/stability/dense_spectrum.hpp"

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
  test::ChainProblem problem(coil);
  const continuation::Borders none_bordered = test::no_borders(problem);
  continuation::Iterate iterate = test::iterate_at(coil, coil.x, none_bordered);
  BOOST_TEST_REQUIRE(continuation::ChordNewton().solve(problem, none_bordered, iterate, {}).converged);
  coil.x = iterate.x;
  const MatrixXd none(coil.chain.size(), 0);
  coil.chain.factor(coil.x, coil.loads, none, none, MatrixXd(0, 0));
  return coil;
}

/// The lowest eigenvalues of a chain, factored where they are asked for.
Spectrum lowest(Chain& chain, const VectorXd& x, const contact::Loads& loads, Parity parity, int count,
                SpectrumSolver& solver) {
  const MatrixXd none(chain.size(), 0);
  chain.factor(x, loads, none, none, MatrixXd(0, 0));
  const chain::Linearisation linearised(chain, {}, x, loads);
  return solver.lowest(chain::Variation(linearised, parity), count);
}

Spectrum lowest(Strut& rod, int count) {
  SpectrumSolver solver;
  return lowest(rod.chain, rod.x, rod.loads, Parity::even, count, solver);
}

/// Pairs solve the assembled problem, and the lowest are those LAPACK finds there.
void check_pairs(const Chain& chain, const VectorXd& x, const contact::Loads& loads, Parity parity,
                 const Spectrum& spectrum) {
  const auto assembled = chain.second_variation(x, loads, parity);
  BOOST_TEST(spectrum.agrees());
  const MatrixXd& v = spectrum.eigenvectors;
  const MatrixXd gram = v.transpose() * (assembled.metric * v);
  // SLEPc's vectors are orthogonal to its tolerance, 1e-8 a pair.
  BOOST_TEST((gram - MatrixXd::Identity(v.cols(), v.cols())).cwiseAbs().maxCoeff() < 1e-6);
  const MatrixXd defect = assembled.matrix * v - assembled.metric * v * spectrum.eigenvalues.asDiagonal();
  const double size = MatrixXd(assembled.matrix).cwiseAbs().rowwise().sum().maxCoeff();
  BOOST_TEST(defect.cwiseAbs().maxCoeff() < 1e-8 * size * v.cwiseAbs().maxCoeff());
  const VectorXd second = test::dense_spectrum(assembled);
  BOOST_TEST_REQUIRE(second.size() >= spectrum.eigenvalues.size());
  for (Eigen::Index k = 0; k < spectrum.eigenvalues.size(); ++k)
    // Rounding of LAPACK's inverse: the matrices' condition of some 1e6.
    BOOST_TEST(std::abs(spectrum.eigenvalues(k) - second(k)) < 1e-9 * (1.0 + std::abs(second(k))));
}

}  // namespace

BOOST_AUTO_TEST_CASE(clamped_strut_has_eulers_loads) {
  // μ_k = (kπ/L)² + T, L = 2: at T = −20 the loads of k = 1, 2 are passed, 2.47 and 9.87, and that of 3, 22.2, is not.
  for (const int elements : {4, 10}) {
    Strut rod = strut(-20.0, true, elements);
    const Spectrum spectrum = lowest(rod, 4);
    check_pairs(rod.chain, rod.x, rod.loads, Parity::even, spectrum);
    BOOST_TEST(spectrum.index == 2);
    BOOST_TEST(!spectrum.rounded);
    BOOST_TEST_REQUIRE(spectrum.eigenvalues.size() == 4);
    for (int k = 1; k <= 4; ++k)  // the fourth mode on four elements sets the tolerance
      BOOST_TEST(spectrum.eigenvalues(k - 1) == 0.25 * k * k * pi * pi - 20.0,
                 boost::test_tools::tolerance(elements < 10 ? 1e-6 : 1e-9));
  }
}

BOOST_AUTO_TEST_CASE(free_straight_rod_under_tension) {
  Strut rod = strut(3.0, false, 12);
  const Spectrum spectrum = lowest(rod, 3);
  check_pairs(rod.chain, rod.x, rod.loads, Parity::even, spectrum);
  BOOST_TEST(spectrum.index == 0);
  for (int k = 0; k < 3; ++k)
    BOOST_TEST(spectrum.eigenvalues(k) == 0.25 * k * k * pi * pi + 3.0, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(all_negative_eigenvalues_come_along) {
  Strut rod = strut(-130.0, true, 12);  // k = 1 … 7: (7π/2)² = 120.9, (8π/2)² = 157.9
  const Spectrum spectrum = lowest(rod, 1);
  BOOST_TEST(spectrum.index == 7);
  BOOST_TEST(spectrum.inertia_index == 7);
  BOOST_TEST_REQUIRE(spectrum.eigenvalues.size() == 7);
  BOOST_TEST(spectrum.eigenvalues(0) == 0.25 * pi * pi - 130.0, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(a_singular_matrix_is_no_failure_and_hides_nothing) {
  for (const int elements : {4, 10}) {
    Strut rod = strut(-0.25 * pi * pi, true, elements);
    const Spectrum spectrum = lowest(rod, 2);
    BOOST_TEST(std::abs(spectrum.eigenvalues(0)) < 1e-9);
    BOOST_TEST(spectrum.eigenvalues(1) == 0.75 * pi * pi, boost::test_tools::tolerance(1e-8));
    if (elements == 10) BOOST_TEST(spectrum.rounded);  // four elements move the load by more than rounding
  }
}

BOOST_AUTO_TEST_CASE(rounding_bounds_the_noise_of_an_eigenvalue) {
  // The same rod on meshes that all resolve it: eigenvalues differ by rounding, and by no more than is said.
  for (const int elements : {10, 20, 40}) {
    Strut rod = strut(-0.25 * pi * pi, true, elements, 8);
    const Spectrum spectrum = lowest(rod, 1);
    BOOST_TEST(std::abs(spectrum.eigenvalues(0)) <= spectrum.rounding(0));
    BOOST_TEST(spectrum.rounding(0) < 1e-8);  // and what is said is no pretext
  }
}

BOOST_AUTO_TEST_CASE(the_coil_loses_even_stability_between_1_4_and_1_2) {
  SpectrumSolver solver;
  for (const double tension : {1.4, 1.2, 1.0, 0.6}) {
    test::Coil coil = equilibrium_coil(tension);
    for (const Parity parity : {Parity::even, Parity::odd}) {
      const Spectrum spectrum = lowest(coil.chain, coil.x, coil.loads, parity, 3, solver);
      BOOST_TEST_MESSAGE("T " << tension << (parity == Parity::even ? " even " : " odd ")
                              << spectrum.eigenvalues.transpose());
      check_pairs(coil.chain, coil.x, coil.loads, parity, spectrum);
      BOOST_TEST(spectrum.index == coil.chain.index(coil.x, coil.loads, parity));
      if (parity == Parity::even && tension == 1.4) BOOST_TEST(spectrum.eigenvalues(0) > 0.0);
      if (parity == Parity::even && tension == 1.2) BOOST_TEST(spectrum.eigenvalues(0) < 0.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_order_of_questions_does_not_matter) {
  // To the last digit: a run that is resumed writes what it would have written.
  test::Coil one = equilibrium_coil(1.0), other = equilibrium_coil(1.4);
  SpectrumSolver solver, fresh;
  lowest(other.chain, other.x, other.loads, Parity::even, 2, solver);
  const VectorXd after = lowest(one.chain, one.x, one.loads, Parity::even, 2, solver).eigenvalues;
  const VectorXd alone = lowest(one.chain, one.x, one.loads, Parity::even, 2, fresh).eigenvalues;
  BOOST_TEST((after - alone).cwiseAbs().maxCoeff() == 0.0);
}

BOOST_AUTO_TEST_CASE(wrong_arguments_are_named) {
  Strut rod = strut(1.0, true, 3);
  BOOST_CHECK_THROW(lowest(rod, 0), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
