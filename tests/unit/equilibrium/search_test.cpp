// All equilibria under given loads, and the energy they are compared by.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/search.hpp"

namespace {

using namespace windlass;
using equilibrium::FoundState;
using equilibrium::Search;
using equilibrium::Solution;

const std::vector<std::string> tension{"load.tension"};

Search at_tension(double T, scene::EndKind ends = scene::EndKind::moment_free) {
  return equilibrium::search(test::coil_scene(T, ends), true, true, tension);
}

Solution recorded(const FoundState& state) {
  return equilibrium::record(*state.at.problem, state.at.x, state.at.p);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(search)

// The envelope theorem: along a branch dV/dT = ∂V/∂T, and V is linear in T at fixed shape, so T dV/dT = V − U.
BOOST_AUTO_TEST_CASE(the_potential_of_a_helix_varies_with_the_tension_as_the_pulled_ends_move) {
  constexpr double T = 0.8, h = 1e-3;
  for (const scene::EndKind ends : {scene::EndKind::moment_free, scene::EndKind::clamped}) {
    const Search below = at_tension(T - h, ends), here = at_tension(T, ends), above = at_tension(T + h, ends);
    BOOST_TEST_REQUIRE((below.stable() && here.stable() && above.stable()));
    const double slope = (above.stable()->potential - below.stable()->potential) / (2.0 * h);
    const double moved = here.stable()->potential - recorded(*here.stable()).energy;
    BOOST_TEST(T * slope == moved, boost::test_tools::tolerance(1e-5));  // h²
  }
}

BOOST_AUTO_TEST_CASE(the_potential_of_a_buckled_strut_varies_with_the_thrust_as_its_ends_approach) {
  constexpr double P = 45.0, h = 1e-2;
  const auto buckled = [](double thrust) {
    scene::Scene scene;
    scene.name = "strut";
    scene.rod.length = 1.0;
    scene.ends.kind = scene::EndKind::clamped;
    scene.load.thrust = thrust;
    return equilibrium::equilibria(scene);
  };
  const auto below = buckled(P - h), here = buckled(P), above = buckled(P + h);
  BOOST_TEST(here.answer.shortening > 0.01);
  const double slope = (above.states[0].potential - below.states[0].potential) / (2.0 * h);
  BOOST_TEST(slope == -here.answer.shortening, boost::test_tools::tolerance(1e-5));  // h²
  BOOST_TEST(here.states[0].index == 0);
}

// The flat coil has given its stability to the helix: a supercritical pitchfork, whose arm lies lower.
BOOST_AUTO_TEST_CASE(the_stable_state_comes_first_and_lies_lowest) {
  const Search found = at_tension(0.8);
  BOOST_TEST_REQUIRE(found.states.size() >= 2u);
  BOOST_TEST(found.states[0].index == 0);
  BOOST_TEST(recorded(found.states[0]).z_span > 0.1);
  for (std::size_t k = 1; k < found.states.size(); ++k) {
    BOOST_TEST(found.states[k].index > 0);
    BOOST_TEST(found.states[k].potential > found.states[0].potential);
  }
}

// At the value itself, not beside it: the mesh's own tolerance is all that is left.
BOOST_AUTO_TEST_CASE(states_are_solved_at_the_loads_asked_for) {
  const Search found = at_tension(0.8);
  for (const FoundState& state : found.states) {
    BOOST_TEST(state.at.p(0) == 0.8);
    BOOST_TEST(state.at.problem->residual(state.at.x, state.at.p).cwiseAbs().maxCoeff() < 1e-9);
    BOOST_TEST(state.at.problem->last_error() < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(one_state_is_listed_once) {
  Search found = at_tension(0.8);
  const std::size_t count = found.states.size();
  equilibrium::include(found, found.states.back().at);
  BOOST_TEST(found.states.size() == count);
}

BOOST_AUTO_TEST_SUITE_END()
