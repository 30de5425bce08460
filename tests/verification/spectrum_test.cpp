// Spectra against each other: infinite tails against long ones, formulas against meshes, half chains against full ones.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/analysis.hpp"

namespace {

using namespace windlass;
using equilibrium::Started;

Started start_of(double tension, double angle, double length, bool spatial, bool half = true,
                 double twist_ratio = 2.0 / 3.0) {
  scene::Scene scene = test::coil_scene(tension);
  scene.rod.twist_ratio = twist_ratio;
  scene.load.angle = angle;
  scene.rod.length = length;
  return equilibrium::cold_start(scene, spatial, half, {"load.tension"});
}

equilibrium::Stability stability_of(Started& start, int count, bool modes = false) {
  stability::SpectrumSolver solver;
  return stability::analyse(*start.problem, start.x, start.p, count, modes, solver);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(spectra)

BOOST_AUTO_TEST_CASE(infinite_tails_have_the_bound_states_of_long_ones) {
  // Touches at 3 pi, a line at 2 pi. A mode below the pull decays along the tails, by e^(−2 √(T − μ) 20) at least here.
  for (const auto& [tension, angle] : {std::pair{0.3, 3.0 * M_PI}, std::pair{1.0, 2.0 * M_PI}}) {
    Started infinite = start_of(tension, angle, std::numeric_limits<double>::infinity(), false);
    Started finite = start_of(tension, angle, 60.0, false);
    const auto a = stability_of(infinite, 2), b = stability_of(finite, 2);
    BOOST_TEST_CONTEXT("T " << tension << ", phi " << angle) {
      BOOST_TEST(a.index == 0);
      BOOST_TEST(a.inertia_index == 0);
      for (std::size_t k = 0; k < 2; ++k)
        if (b.eigenvalues.at(k) < 0.9 * tension)  // the meshes of these tails resolve them to a millionth
          BOOST_TEST(std::abs(a.eigenvalues.at(k) - b.eigenvalues.at(k)) < 1e-6);
        else
          BOOST_TEST(a.eigenvalues.at(k) > 0.9 * tension);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_formula_with_a_mesh_in_its_place_has_the_spectrum_of_a_meshed_tail) {
  // With modes the tail is solved again on its mesh, without them the mesh lies on the exact elastica. Both meshes are
  // good to 1e-9.
  for (const bool spatial : {false, true})
    for (const double length : {20.0, 30.0}) {
      Started start = start_of(1.0, 2.0 * M_PI, length, spatial);
      const auto formula = stability_of(start, 4), mesh = stability_of(start, 4, true);
      BOOST_TEST_REQUIRE(formula.eigenvalues.size() == mesh.eigenvalues.size());
      for (std::size_t k = 0; k < 4; ++k)
        BOOST_TEST(std::abs(formula.eigenvalues[k] - mesh.eigenvalues[k]) <
                   1e-8 * (0.01 + std::abs(mesh.eigenvalues[k])));
      BOOST_TEST(formula.index == mesh.index);
    }
}

BOOST_AUTO_TEST_CASE(a_half_chain_has_the_spectrum_of_the_full_one) {
  for (const bool spatial : {false, true}) {
    Started half = start_of(0.8, 2.0 * M_PI, 24.0, spatial, true),
            full = start_of(0.8, 2.0 * M_PI, 24.0, spatial, false);
    const auto a = stability_of(half, 6), b = stability_of(full, 6);
    BOOST_TEST(a.index == b.index);
    for (std::size_t k = 0; k < 6; ++k)  // on meshes that differ
      BOOST_TEST(std::abs(a.eigenvalues.at(k) - b.eigenvalues.at(k)) < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(twisting_of_long_tails_does_not_hide_a_loss_of_stability) {
  // The flat coil's mode out of its plane stays where the coil is. Beside it the tails twist, at c (kπ/L)², so that a long
  // rod has dozens of positive eigenvalues nearer to zero than the negative one.
  for (const bool half : {true, false}) {
    Started brief = start_of(0.7, 2.0 * M_PI, 24.0, true, half, 0.02),
            lengthy = start_of(0.7, 2.0 * M_PI, 90.0, true, half, 0.02);
    const auto a = stability_of(brief, 1), b = stability_of(lengthy, 1);
    for (const auto& found : {a, b}) {
      BOOST_TEST(found.inertia_index == 1);
      BOOST_TEST(found.index == 1);
    }
    BOOST_TEST(a.eigenvalues.at(0) < -0.1);
    BOOST_TEST(a.eigenvalues.at(0) == b.eigenvalues.at(0), boost::test_tools::tolerance(1e-3));
  }
}

BOOST_AUTO_TEST_SUITE_END()
