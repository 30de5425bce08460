// Directions that knots give way in, against the second variation of a polygon, and what sliding of a knot along its rod costs.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>

#include "discrete_hessian.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/quaternion.hpp"
#include "windlass/scene/reader.hpp"
#include "windlass/stability/analysis.hpp"

using namespace windlass;

namespace {

/// A shipped knot, half-turn symmetric, with the stability of both parities.
equilibrium::Solution tied(const std::string& name, const std::vector<std::string>& settings = {}) {
  const scene::Scene scene =
      scene::read_scene(std::string(std::getenv("WINDLASS_SCENES")) + "/" + name + ".toml", settings);
  equilibrium::Started start = equilibrium::cold_start(scene, true, true, {equilibrium::load_key(scene)});
  stability::SpectrumSolver solver;
  equilibrium::Solution out = equilibrium::record(*start.problem, start.x, start.p);
  out.stability = stability::analyse(*start.problem, start.x, start.p, 3, false, solver);
  return out;
}

Eigen::Index negative(const Eigen::VectorXd& values) { return (values.array() < 0.0).count(); }

}  // namespace

BOOST_AUTO_TEST_SUITE(knot_index)

BOOST_AUTO_TEST_CASE(an_overhand_knot_gives_way_in_no_direction) {
  // Vertices about as near each other as the touches that stand for its line.
  const equilibrium::Solution state = tied("overhand-knot");
  BOOST_TEST(state.stability->index == 0);
  BOOST_TEST(state.stability->inertia_index == 0);
  const Eigen::VectorXd held = test::DiscreteHessian{0.03, true}.eigenvalues(state),
                        sliding = test::DiscreteHessian{0.03, false}.eigenvalues(state);
  BOOST_TEST(negative(held) == 0);
  // Without the gauge there is one eigenvalue more, and it is the slide's: zero but for what mesh and touches make of it.
  constexpr double nearly = 0.1;
  BOOST_TEST(std::abs(sliding(0)) < nearly * sliding(1));
  BOOST_TEST(sliding(1) == held(0), boost::test_tools::tolerance(nearly));
}

BOOST_AUTO_TEST_CASE(slender_and_stout_overhand_knots_are_stable) {
  // However many touches stand for the line: 17 to 39 of them.
  for (const char* radius : {"rod.radius=0.02", "rod.radius=0.05", "rod.radius=0.2"}) {
    const equilibrium::Solution state = tied("overhand-knot", {radius});
    BOOST_TEST(state.stability->index == 0, radius);
    BOOST_TEST(state.stability->inertia_index == 0, radius);
    BOOST_TEST(state.stability->eigenvalues.front() > 0.0, radius);
  }
}

BOOST_AUTO_TEST_CASE(a_knot_slides_towards_the_nearer_end) {
  // dΠ/dδ is the difference of H at the two ends, T cos ψ where no moment holds them, and ψ there grows as exp(kδ), k = √(T/B):
  // d²Π/dδ² = −2 T k ψ². The next terms are smaller by exp(−2 k ℓ), ℓ = 7 the length of a tail: 4e-5.
  constexpr double pull = 0.5;
  const equilibrium::Solution state = tied("overhand-knot", {"rod.length=24"});
  const equilibrium::ArcRecord& tail = state.arcs.back();
  const Eigen::Vector3d tangent = rod::directors(Eigen::Vector4d(tail.q.col(tail.q.cols() - 1))).col(2);
  const double square = tangent(1) * tangent(1) + tangent(2) * tangent(2);
  BOOST_TEST(state.stability->sliding == -2.0 * pull * std::sqrt(pull) * square,
             boost::test_tools::tolerance(1e-3));
  BOOST_TEST(state.stability->index == 0);
}

BOOST_AUTO_TEST_CASE(a_half_knot_leans_along_the_cylinder) {
  // Its one direction is true: clasp and tails lean along the axis over the two touches.
  const equilibrium::Solution state = tied("half-knot");
  BOOST_TEST(state.stability->index == 1);
  const Eigen::VectorXd coarse = test::DiscreteHessian{0.1, true}.eigenvalues(state),
                        fine = test::DiscreteHessian{0.05, true}.eigenvalues(state);
  BOOST_TEST(negative(coarse) == 1);
  BOOST_TEST(negative(fine) == 1);
  constexpr double percent = 0.05;  // what halving the mesh changes: neither value is the mesh's
  BOOST_TEST(fine(0) == coarse(0), boost::test_tools::tolerance(percent));
  BOOST_TEST(fine(1) == coarse(1), boost::test_tools::tolerance(percent));
}

BOOST_AUTO_TEST_SUITE_END()
