// Observed order of Gauss collocation: 2m at the nodes, for planar and Kirchhoff arcs.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "observed_order.hpp"
#include "support/coil_scene.hpp"
#include "windlass/chain/guess.hpp"
#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"

namespace {

using namespace windlass;
using chain::Stretch;

/// R_tot of the 2π coil at T = 1 on a uniform tail mesh, no adaptation.
double total_force(bool spatial, int stages, int elements) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.load.tension = 1.0;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 2.0 * (rod::capstan::phi_star(1.0, 2 * M_PI) + 18.0);
  const chain::Topology topology{{Stretch::line, Stretch::tail}, true, false};
  const std::vector<chain::ArcMesh> meshes{{chain::uniform_mesh(4), stages},
                                           {chain::uniform_mesh(elements), stages}};
  equilibrium::RodProblem problem(scene, spatial, topology, meshes, {"load.tension"});
  const double half = 0.5 * scene.rod.length, contact = rod::capstan::phi_star(1.0, 2 * M_PI);
  Eigen::VectorXd x =
      chain::guess_state(problem.chain(), topology, problem.rod(),
                         chain::capstan_profile(1.0, 2 * M_PI, half, 1.0), {0.0, contact, half});
  const Eigen::VectorXd p = problem.parameters();
  BOOST_REQUIRE(problem.polish(x, p) >= 0);
  return problem.target(problem.chain(), x, problem.loads(p));
}

/// The crossing's force of a thick 2π coil (R/r = 2.5) on uniform meshes, from the state that the program finds.
double crossing_force(const equilibrium::Started& found, const scene::Scene& scene, int stages,
                      int elements) {
  test::OnMeshes state = test::on_uniform_meshes(found, scene, stages, elements);
  for (const chain::Contact& contact : state.problem.profile(state.x, found.p).contacts)
    if (contact.coupling >= 0) return contact.force;
  BOOST_FAIL("no touch between strands");
  return 0.0;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(convergence)

BOOST_AUTO_TEST_CASE(order_with_contact_of_the_rod_with_itself) {
  scene::Scene scene = test::thick_coil_scene();
  scene.model.tolerance = 1e-12;
  const equilibrium::Started found = equilibrium::cold_start(scene, true, true, {"load.tension"});
  const double exact = crossing_force(found, scene, 6, 48);
  test::check_order(exact,
                    [&](int stages, int elements) { return crossing_force(found, scene, stages, elements); });
}

BOOST_AUTO_TEST_CASE(order_is_twice_the_number_of_stages) {
  const double exact = rod::capstan::total_force(1.0, 2 * M_PI);
  for (bool spatial : {false, true})
    for (int stages : {2, 3, 4}) {
      // Meshes where the error is well above rounding and asymptotic.
      const int coarse = stages == 2 ? 48 : stages == 3 ? 24 : 16;
      BOOST_TEST_CONTEXT("spatial " << spatial)
      test::check_order(stages, coarse, exact, [&](int m, int n) { return total_force(spatial, m, n); });
    }
}

BOOST_AUTO_TEST_CASE(the_estimate_bounds_the_error) {
  const double exact = rod::capstan::total_force(0.9, 2 * M_PI);
  for (double tolerance : {1e-5, 1e-7, 1e-9}) {
    scene::Scene scene;
    scene.has_cylinder = true;
    scene.load.tension = 0.9;
    scene.load.angle = 2.0 * M_PI;
    scene.rod.length = 2.0 * (rod::capstan::phi_star(0.9, 2 * M_PI) + 20.0);
    scene.model.tolerance = tolerance;
    const chain::Topology topology{{Stretch::line, Stretch::tail}, true, false};
    equilibrium::RodProblem problem(scene, false, topology, {{}, {chain::uniform_mesh(20), 4}},
                                    {"load.tension"});
    const double half = 0.5 * scene.rod.length, contact = rod::capstan::phi_star(0.9, 2 * M_PI);
    Eigen::VectorXd x =
        chain::guess_state(problem.chain(), topology, problem.rod(),
                           chain::capstan_profile(0.9, 2 * M_PI, half, 1.0), {0.0, contact, half});
    const Eigen::VectorXd p = problem.parameters();
    BOOST_REQUIRE(problem.polish(x, p) >= 0);
    x = problem.refine(x, p);
    const double error = std::abs(problem.target(problem.chain(), x, problem.loads(p)) / exact - 1.0);
    const double estimate = problem.error_estimate(x, p);
    BOOST_TEST_CONTEXT("tolerance " << tolerance << ", error " << error << ", estimate " << estimate) {
      BOOST_TEST(estimate <= tolerance);
      BOOST_TEST(error <= estimate + 1e-13);  // rounding in the exact value
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
