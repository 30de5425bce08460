// Where the flat coil loses its stability, found in two ways that share no step: the singular boundary value problem, and
// the zero of SLEPc's lowest eigenvalue over states solved at given tensions.
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/walker.hpp>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/spectrum.hpp"

namespace {

using namespace windlass;
using continuation::PointType;
using equilibrium::Started;

scene::Scene coil(double tension, scene::EndKind ends) {
  scene::Scene scene = test::coil_scene(tension, ends);
  scene.model.tolerance = 1e-9;
  return scene;
}

/// First branch point below the start.
double singular_tension(Started& start) {
  continuation::Options options;
  options.target = 0.9;
  options.direction = -1;
  continuation::Walker walker(start.problem, start.x, start.p, options);
  while (const auto point = walker.step())
    if (point->type == PointType::branch_point) return point->p(0);
  return NAN;
}

/// Zero in T of the lowest eigenvalue, each state by Newton from its neighbour.
double eigenvalue_tension(Started& start, double low, double high) {
  stability::SpectrumSolver solver;
  const auto lowest = [&](double tension) {
    start.p(0) = tension;
    // Next to the singular state Newton's increments along the mode stay at rounding over eigenvalue and are not judged;
    // the residual is.
    start.problem->polish(start.x, start.p);
    BOOST_TEST_REQUIRE(start.problem->residual(start.x, start.p).lpNorm<Eigen::Infinity>() < 1e-8);
    const chain::Linearisation linearised(start.problem->factored(start.x, start.p), start.problem->rod(),
                                          start.x, start.problem->loads(start.p));
    return solver.lowest(chain::Variation(linearised, contact::Parity::even), 1).eigenvalues(0);
  };
  std::uintmax_t most = 60;
  const auto bracket = boost::math::tools::toms748_solve(lowest, low, high,
                                                         boost::math::tools::eps_tolerance<double>(32), most);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(transition)

BOOST_AUTO_TEST_CASE(the_singular_problem_and_the_eigenvalue_agree) {
  for (const auto ends : {scene::EndKind::moment_free, scene::EndKind::clamped}) {
    std::vector<double> found;
    for (const bool half : {true, false}) {
      Started start = equilibrium::cold_start(coil(1.6, ends), true, half, {"load.tension"});
      Started other = equilibrium::cold_start(coil(1.35, ends), true, half, {"load.tension"});
      const double singular = singular_tension(start);
      const double eigen = eigenvalue_tension(other, 1.1, 1.35);
      BOOST_TEST_CONTEXT("ends " << static_cast<int>(ends) << ", half " << half << ": " << singular << " and "
                                 << eigen) {
        // Two meshes, each good to 1e-9 in R_tot.
        BOOST_TEST(std::abs(singular - eigen) < 1e-7);
      }
      found.push_back(singular);
    }
    // The even mode comes first with these ends, so that half and full chain see the same point.
    BOOST_TEST(std::abs(found[0] - found[1]) < 1e-8);
  }
}

BOOST_AUTO_TEST_SUITE_END()
