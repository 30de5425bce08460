#include "windlass/equilibrium/newton.hpp"

#include <petscsys.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "unit/equilibrium/coil.hpp"
#include "windlass/petsc/session.hpp"

using namespace windlass;
using Eigen::VectorXd;
using equilibrium::NewtonOptions;
using equilibrium::NewtonResult;
using equilibrium::NewtonSolver;

BOOST_AUTO_TEST_SUITE(newton)

namespace {

VectorXd disturbed(const test::Coil& coil, double amplitude) {
  std::srand(7);
  return coil.chain.retract(coil.x, amplitude * VectorXd::Random(coil.chain.size()));
}

/// An option of PETSc for as long as the object lives.
struct ScopedOption {
  explicit ScopedOption(const char* name) : name_(name) {
    petsc::ensure_session();
    petsc::check(PetscOptionsSetValue(nullptr, name, nullptr));
  }
  ~ScopedOption() { PetscOptionsClearValue(nullptr, name_); }
  const char* name_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(planar_coil_meets_the_closed_form) {
  test::Coil coil = test::planar_coil(1.0);
  NewtonSolver solver;
  VectorXd x = disturbed(coil, 0.05);
  const NewtonResult result = solver.solve(coil.chain, x, coil.loads);
  BOOST_TEST_MESSAGE("planar: " << result.iterations << " iterations, " << result.reason);
  BOOST_TEST(result.converged);
  BOOST_TEST(result.residual < 1e-11);
  BOOST_TEST(result.increment < 1e-10);
  BOOST_TEST(result.iterations <= 8);
  const double phi_star = std::numbers::pi - std::acos(1.0 - 0.5 / coil.loads.tension);
  BOOST_TEST(std::abs(*coil.chain.coordinates(x, 1) - phi_star) < 1e-9);
  BOOST_TEST(std::abs(*coil.chain.force(x, 0) - 1.5) < 1e-9);
}

BOOST_AUTO_TEST_CASE(an_exact_guess_takes_no_iteration) {
  test::Coil coil = test::planar_coil(1.0);
  NewtonSolver solver;
  BOOST_TEST(solver.solve(coil.chain, coil.x, coil.loads).converged);
  const VectorXd before = coil.x;
  const NewtonResult again = solver.solve(coil.chain, coil.x, coil.loads);
  BOOST_TEST(again.converged);
  BOOST_TEST(again.iterations == 0);
  BOOST_TEST((coil.x - before).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(frames_converge_quadratically) {
  test::Coil coil = test::spatial_coil(1.0);
  const VectorXd start = disturbed(coil, 0.03);
  VectorXd solution = start;
  NewtonSolver solver;
  BOOST_TEST(solver.solve(coil.chain, solution, coil.loads).converged);
  // Errors after k iterations, by stopping early: each the square of the last, up to a constant.
  std::vector<double> residuals;
  for (int k = 1; k <= 8; ++k) {
    NewtonOptions options;
    options.max_iterations = k;
    VectorXd x = start;
    const NewtonResult result = NewtonSolver().solve(coil.chain, x, coil.loads, options);
    residuals.push_back(result.residual);
    BOOST_TEST_MESSAGE("iteration " << k << " residual " << result.residual << " " << result.reason);
    if (result.converged) break;
  }
  const std::size_t last = residuals.size() - 1;
  BOOST_TEST_REQUIRE(last >= 2);
  const double exponent = std::log(residuals[last - 1]) / std::log(residuals[last - 2]);
  BOOST_TEST(exponent > 1.6);
}

BOOST_AUTO_TEST_CASE(a_step_out_of_the_domain_is_cut) {
  // With the edge misplaced towards the rod's end, full steps make arcs of negative length: the line search backs
  // off, and the solver ends with a state or with a reason, the start untouched.
  NewtonSolver solver;
  for (double edge : {0.05, 0.3, 14.9}) {
    test::Coil coil = test::planar_coil(1.0);
    coil.chain.set_arclength(coil.x, 1, edge);
    VectorXd x = coil.x;
    const NewtonResult result = solver.solve(coil.chain, x, coil.loads);
    BOOST_TEST_MESSAGE("edge at " << edge << ": " << result.iterations << " iterations, " << result.reason);
    if (edge < 1.0) BOOST_TEST(result.converged);
    if (!result.converged) BOOST_TEST((x - coil.x).norm() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(a_start_outside_the_domain_is_a_reason) {
  test::Coil coil = test::planar_coil(1.0);
  // Beyond the rod's end: no tail is left. (A contact arc of negative length is inside the domain.)
  coil.chain.set_arclength(coil.x, 1, 16.0);
  const NewtonResult result = NewtonSolver().solve(coil.chain, coil.x, coil.loads);
  BOOST_TEST(!result.converged);
  BOOST_TEST(result.reason.find("DOMAIN") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_assembled_matrix_gives_the_same_state) {
  test::Coil coil = test::spatial_coil(1.2);
  VectorXd shell = disturbed(coil, 0.02), assembled = shell;
  BOOST_TEST(NewtonSolver().solve(coil.chain, shell, coil.loads).converged);
  const ScopedOption option("-windlass_assembled");
  const NewtonResult result = NewtonSolver().solve(coil.chain, assembled, coil.loads);
  BOOST_TEST(result.converged);
  BOOST_TEST(result.iterations <= 8);
  BOOST_TEST((shell - assembled).cwiseAbs().maxCoeff() < 1e-9);
}

BOOST_AUTO_TEST_CASE(wrong_options_name_the_bound) {
  test::Coil coil = test::planar_coil(1.0);
  NewtonOptions options;
  options.increment_tolerance = 0.0;
  BOOST_CHECK_THROW(NewtonSolver().solve(coil.chain, coil.x, coil.loads, options), std::invalid_argument);
  VectorXd short_state = coil.x.head(3);
  BOOST_CHECK_THROW(NewtonSolver().solve(coil.chain, short_state, coil.loads), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
