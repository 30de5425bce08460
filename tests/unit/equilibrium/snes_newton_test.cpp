#include "windlass/equilibrium/snes_newton.hpp"

#include <petscsys.h>
#include <petscvec.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "unit/equilibrium/chain_problem.hpp"
#include "windlass/petsc/handles.hpp"

using namespace windlass;
using continuation::Borders;
using continuation::CorrectorReport;
using continuation::Iterate;
using continuation::Options;
using Eigen::VectorXd;
using equilibrium::SnesNewton;

BOOST_AUTO_TEST_SUITE(snes_newton)

namespace {

VectorXd disturbed(const test::Coil& coil, double amplitude) {
  std::srand(7);
  return coil.chain.retract(coil.x, amplitude * VectorXd::Random(coil.chain.size()));
}

double whole(const Iterate&, const VectorXd&) { return 1.0; }

/// Solves the coil from x, which becomes the solution.
CorrectorReport solve(test::Coil& coil, VectorXd& x, const Options& options = {}) {
  test::ChainProblem problem(coil);
  const Borders none = test::no_borders(problem);
  Iterate iterate = test::iterate_at(coil, x, none);
  const CorrectorReport report = SnesNewton().solve_from_guess(problem, none, iterate, options, whole);
  x = iterate.x;
  return report;
}

/// An option of PETSc for as long as the object lives.
struct ScopedOption {
  ScopedOption(const char* name, const char* value) : name_(name) {
    petsc::ensure_session();
    petsc::check(PetscOptionsSetValue(nullptr, name, value));
  }
  ~ScopedOption() { PetscOptionsClearValue(nullptr, name_); }
  const char* name_;
};

/// PETSc numbers its objects as it makes them.
PetscObjectId next_object() {
  const petsc::VecHandle vector = petsc::zero_vector(1);
  PetscObjectId id = 0;
  petsc::check(PetscObjectGetId(reinterpret_cast<PetscObject>(vector.get()), &id));
  return id;
}

}  // namespace

BOOST_AUTO_TEST_CASE(planar_coil_meets_the_closed_form) {
  test::Coil coil = test::planar_coil(1.0);
  VectorXd x = disturbed(coil, 0.05);
  const CorrectorReport report = solve(coil, x);
  BOOST_TEST(report.converged, report.failure);
  BOOST_TEST(report.iterations <= 8);
  const double phi_star = std::numbers::pi - std::acos(1.0 - 0.5 / coil.loads.tension);
  BOOST_TEST(std::abs(*coil.chain.coordinates(x, 1) - phi_star) < 1e-9);
  BOOST_TEST(std::abs(*coil.chain.force(x, 0) - 1.5) < 1e-9);
}

BOOST_AUTO_TEST_CASE(an_exact_guess_takes_no_correction) {
  test::Coil coil = test::planar_coil(1.0);
  BOOST_TEST(solve(coil, coil.x).converged);
  const VectorXd before = coil.x;
  const CorrectorReport again = solve(coil, coil.x);
  BOOST_TEST(again.converged);
  BOOST_TEST(again.iterations == 0);
  // What rounding leaves of F, times the inverse.
  BOOST_TEST((coil.x - before).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(the_library_s_own_corrector_gives_the_same_bits) {
  // The largest disturbance fails; of the others some let factors serve twice, some have them renewed.
  for (const double amplitude : {1e-5, 1e-3, 0.02}) {
    test::Coil coil = test::spatial_coil(1.2);
    test::ChainProblem problem(coil);
    for (const Borders& borders : {test::no_borders(problem),
                                   test::free_tension(VectorXd::Unit(problem.size(), problem.size() / 2))}) {
      Iterate snes = test::iterate_at(coil, disturbed(coil, amplitude), borders), own = snes;
      const CorrectorReport by_snes = SnesNewton().solve(problem, borders, snes, {});
      const CorrectorReport by_own = continuation::ChordNewton().solve(problem, borders, own, {});
      BOOST_TEST(by_own.converged == (amplitude < 0.01), by_own.failure);
      BOOST_TEST(by_snes.converged == by_own.converged);
      BOOST_TEST(by_snes.failure == by_own.failure);
      BOOST_TEST((snes.x - own.x).norm() == 0.0);
      BOOST_TEST((snes.p - own.p).norm() == 0.0);
      BOOST_TEST(by_snes.iterations == by_own.iterations);
      BOOST_TEST(by_snes.factorizations == by_own.factorizations);
      BOOST_TEST(by_snes.contraction == by_own.contraction);
      BOOST_TEST(by_snes.factored_here == by_own.factored_here);
    }
  }
}

BOOST_AUTO_TEST_CASE(frames_converge_quadratically) {
  test::Coil coil = test::spatial_coil(1.0);
  const VectorXd start = disturbed(coil, 0.03);
  std::vector<double> residuals;
  for (int k = 0; k <= 8; ++k) {
    Options options;
    options.max_newton = k;
    VectorXd x = start;
    const CorrectorReport report = solve(coil, x, options);
    residuals.push_back(report.residual);
    if (report.converged) break;
  }
  // Each residual is the square of the last, up to a constant; the last one may be rounding.
  const std::size_t last = residuals.size() - 2;
  BOOST_TEST_REQUIRE(last >= 2u);
  BOOST_TEST(std::log(residuals[last]) / std::log(residuals[last - 1]) > 1.6);
}

BOOST_AUTO_TEST_CASE(a_part_of_a_correction_is_taken_where_asked) {
  test::Coil coil = test::planar_coil(1.0);
  test::ChainProblem problem(coil);
  const Borders none = test::no_borders(problem);
  Iterate iterate = test::iterate_at(coil, disturbed(coil, 0.05), none);
  double largest = 0.0;
  constexpr double reach = 0.01;
  VectorXd before = iterate.x;
  Options options;
  options.max_newton = 100;
  const CorrectorReport report = SnesNewton().solve_from_guess(
      problem, none, iterate, options, [&](const Iterate& at, const VectorXd& dx) {
        largest = std::max(largest, (at.x - before).cwiseAbs().maxCoeff());
        before = at.x;
        return std::min(1.0, reach / dx.cwiseAbs().maxCoeff());
      });
  BOOST_TEST(report.converged, report.failure);
  BOOST_TEST(largest > 0.99 * reach);
  BOOST_TEST(largest < 1.01 * reach);
}

BOOST_AUTO_TEST_CASE(what_fails_is_a_reason) {
  test::Coil coil = test::planar_coil(1.0);
  // Beyond the rod's end: no tail is left. (A contact arc of negative length is inside the domain.)
  VectorXd beyond = coil.x;
  coil.chain.set_arclength(beyond, 1, 16.0);
  const CorrectorReport outside = solve(coil, beyond);
  BOOST_TEST(!outside.converged);
  BOOST_TEST(outside.failure.find("domain") != std::string::npos, outside.failure);

  VectorXd far = disturbed(coil, 0.05);
  Options options;
  options.max_newton = 1;
  const CorrectorReport short_of_it = solve(coil, far, options);
  BOOST_TEST(!short_of_it.converged);
  BOOST_TEST(short_of_it.failure.find("no convergence in 1 corrections") == 0u, short_of_it.failure);
}

BOOST_AUTO_TEST_CASE(the_users_words_to_petsc_win) {
  constexpr int elements = 7;  // a size of its own: options are read when PETSc's objects are made
  test::Coil coil = test::planar_coil(1.0, elements);
  VectorXd x = disturbed(coil, 0.05);
  const ScopedOption option("-snes_max_it", "1");
  const CorrectorReport report = solve(coil, x);
  BOOST_TEST(!report.converged);
  BOOST_TEST(report.iterations == 2);  // one was taken, and the next was still due
}

BOOST_AUTO_TEST_CASE(other_line_searches_krylov_methods_and_tests_work) {
  int elements = 8;
  for (const auto& [name, value] :
       {std::pair("-snes_linesearch_type", "bt"), std::pair("-ksp_type", "gmres"),
        std::pair("-snes_convergence_test", "default"), std::pair("-snes_lag_jacobian", "1")}) {
    test::Coil coil = test::planar_coil(1.0, ++elements + 6);
    VectorXd x = disturbed(coil, 0.02);
    const ScopedOption option(name, value), tolerance("-snes_rtol", "1e-10");
    const CorrectorReport report = solve(coil, x);
    BOOST_TEST(report.converged, name << ": " << report.failure);
    BOOST_TEST(std::abs(*coil.chain.force(x, 0) - 1.5) < 1e-8, name);
  }
}

BOOST_AUTO_TEST_CASE(nothing_of_petsc_is_made_in_a_solve) {
  test::Coil coil = test::spatial_coil(1.0);
  VectorXd x = disturbed(coil, 0.02);
  solve(coil, x);
  const int made = SnesNewton::made();
  const PetscObjectId before = next_object();
  for (int k = 0; k < 5; ++k) {
    VectorXd again = disturbed(coil, 0.005 * k);
    BOOST_TEST(solve(coil, again).converged);
  }
  BOOST_TEST(SnesNewton::made() == made);
  BOOST_TEST(next_object() - before == 1);
  // Another size has its own; the first one's are still there.
  test::Coil other = test::planar_coil(1.0, 9);
  VectorXd y = disturbed(other, 0.01), z = disturbed(coil, 0.01);
  solve(other, y);
  solve(coil, z);
  BOOST_TEST(SnesNewton::made() == made + 1);
}

BOOST_AUTO_TEST_SUITE_END()
