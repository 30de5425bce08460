// Helical coils: the endless helix inside long ones, and half against full chains.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "observed_order.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/search.hpp"
#include "windlass/rod/quaternion.hpp"

namespace {

using namespace windlass;
using equilibrium::Solution;
using equilibrium::Started;

scene::Scene long_coil(double tension, double turns) {
  scene::Scene scene;
  scene.name = "coil";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = 2.0 * M_PI * turns;
  scene.rod.length = scene.load.angle + 20.0;
  scene.model.tolerance = 1e-9;
  return scene;
}

/// The stable helical state of the scene.
Started helical(const scene::Scene& scene) {
  const equilibrium::Search found = equilibrium::search(scene, true, true, {"load.tension"});
  BOOST_TEST_REQUIRE(found.stable() != nullptr);
  return found.stable()->at;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(helix)

BOOST_AUTO_TEST_CASE(the_middle_of_long_coils_is_the_endless_helix) {
  // T = 3/2 cos⁴ψ, p = n_t = cos⁴ψ, n_z = 0 (PHYSICS).
  const double tension = 1.2, cos4 = tension / 1.5, psi = std::acos(std::pow(cos4, 0.25));
  std::vector<double> off_angle, off_pressure;
  for (const double turns : {1.0, 2.0, 4.0}) {
    Started rod = helical(long_coil(tension, turns));
    const chain::Profile profile = rod.problem->profile(rod.x, rod.p);
    const chain::Piece& middle = profile.pieces.front();  // starts at s = 0
    off_angle.push_back(std::abs(std::abs(middle.inclination(0)) - psi));
    off_pressure.push_back(std::abs(middle.p(0) - cos4));
    BOOST_TEST(std::abs(middle.n(2, 0)) < 1e-9);
  }
  BOOST_TEST_MESSAGE("psi off by " << off_angle[0] << " " << off_angle[1] << " " << off_angle[2] << ", p by "
                                   << off_pressure[0] << " " << off_pressure[1] << " " << off_pressure[2]);
  // The ends are forgotten exponentially: each doubling of the coil squares the ratio.
  for (std::size_t k = 1; k < off_angle.size(); ++k) {
    BOOST_TEST(off_angle[k] < 0.2 * off_angle[k - 1]);
    BOOST_TEST(off_pressure[k] < 0.2 * off_pressure[k - 1]);
  }
  BOOST_TEST(off_angle.back() < 1e-4);
  BOOST_TEST(off_pressure.back() < 1e-4);
}

BOOST_AUTO_TEST_CASE(half_and_full_chains_agree_on_helices) {
  for (const double tension : {1.1, 0.7}) {
    Started half = helical(long_coil(tension, 1.0));
    Started full = equilibrium::unfold(*half.problem, half.x, half.p, 0);
    const Solution a = equilibrium::record(*half.problem, half.x, half.p);
    const Solution b = equilibrium::record(*full.problem, full.x, full.p);
    BOOST_TEST_CONTEXT("T " << tension) {
      BOOST_TEST(a.tilt > 0.05);
      // The same equations on mirrored meshes: equal up to rounding, which the tail amplifies.
      BOOST_TEST(a.R_tot == b.R_tot, boost::test_tools::tolerance(1e-10));
      BOOST_TEST(a.energy == b.energy, boost::test_tools::tolerance(1e-10));
      BOOST_TEST(a.tilt == b.tilt, boost::test_tools::tolerance(1e-9));
      BOOST_TEST(half.problem->total_index(half.x, half.p) == full.problem->total_index(full.x, full.p));
    }
  }
}

BOOST_AUTO_TEST_CASE(observed_order_on_a_helix_is_twice_the_number_of_stages) {
  Started start = helical(long_coil(1.0, 1.0));
  const auto& topology = start.problem->topology();
  const auto force = [&](int stages, int factor) {
    std::vector<chain::ArcMesh> meshes{{chain::uniform_mesh(2 * factor), stages},
                                       {chain::uniform_mesh(12 * factor), stages}};
    equilibrium::RodProblem problem(start.problem->scene_at(start.p), true, topology, meshes,
                                    {"load.tension"});
    const chain::Profile shape = start.problem->profile(start.x, start.p);
    const contact::Loads loads = start.problem->loads(start.p);
    std::vector<double> s;
    for (int j = 0; j < start.problem->chain().joint_count(); ++j)
      s.push_back(start.problem->chain().arclength(start.x, loads, j));
    Eigen::VectorXd x = chain::guess_state(problem.chain(), topology, problem.rod(), shape, s);
    BOOST_TEST_REQUIRE(problem.polish(x, start.p) >= 0);
    return problem.target(problem.chain(), x, problem.loads(start.p));
  };
  const double exact = force(6, 4);  // order 12 on the finest mesh: exact to rounding
  // Two meshes still differ from the asymptotic order by a few tenths.
  for (const int stages : {2, 3}) test::check_order(stages, 2, exact, force);
}

BOOST_AUTO_TEST_SUITE_END()
