// The second opinion on thick rods: chain and discrete rod agree, and what its table says.
#include "windlass/precision/second_opinion.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/coil_scene.hpp"
#include "support/petsc_session.hpp"

using namespace windlass;

BOOST_FIXTURE_TEST_SUITE(second_opinions, test::PetscSession)

BOOST_AUTO_TEST_CASE(chain_and_discrete_rod_agree_on_one_touch_and_on_two) {
  precision::StudyOptions options;
  options.quick = true;
  const auto opinion = precision::second_opinion(test::thick_coil_scene(), {{2.0, 8.0}, {}}, options);
  BOOST_TEST(opinion.failures.empty());
  BOOST_REQUIRE(opinion.states.size() == 2u);
  for (const precision::Opinion& o : opinion.states) {
    BOOST_TEST_MESSAGE(o.topology << ": " << o.R_tot_difference << ", " << o.self_force_difference);
    BOOST_TEST(o.chain.self_force > 0.0);
    BOOST_TEST(o.agrees());
    BOOST_TEST(o.meshes.size() == 3u);
    BOOST_TEST(std::abs(o.R_tot_difference) < 1e-4);
    BOOST_TEST(std::abs(o.self_force_difference) < 4e-3);  // three meshes only, beside a split
  }
}

BOOST_AUTO_TEST_CASE(a_state_that_cannot_be_is_named) {
  precision::StudyOptions options;
  options.quick = true;
  scene::Scene scene = test::thick_coil_scene();
  scene.rod.length = 7.0;  // the discrete rod wants tails
  const auto opinion = precision::second_opinion(scene, {}, options);
  BOOST_TEST(opinion.states.empty());
  BOOST_REQUIRE(opinion.failures.size() == 1u);
  BOOST_TEST(opinion.failures[0].find("T = 2, R/r = 2.5: ") == 0u);
}

BOOST_AUTO_TEST_CASE(it_is_for_thick_rods_with_free_ends) {
  scene::Scene scene = test::thick_coil_scene();
  BOOST_TEST(precision::has_second_opinion(scene));
  BOOST_TEST(precision::default_states(scene).tensions.size() == 6u);
  scene.load.angle = 4.0 * M_PI;
  BOOST_TEST(precision::default_states(scene).tensions.size() == 5u);
  scene.knot.kind = scene::KnotKind::clove_hitch;
  BOOST_TEST(precision::default_states(scene).tensions.size() >= 8u);  // at each of three ratios of radii
  scene.ends.kind = scene::EndKind::clamped;
  BOOST_TEST(!precision::has_second_opinion(scene));
  scene = test::thick_coil_scene();
  scene.self_contact = false;
  BOOST_TEST(!precision::has_second_opinion(scene));
}

BOOST_AUTO_TEST_CASE(the_table_has_a_row_a_state_and_says_the_worst) {
  precision::SecondOpinion opinion;
  opinion.angle = 2.0 * M_PI;
  opinion.states = {{2.0, 0.25, "tail line tail", {10.0, 1.0, 0.5}, {10.01, 0.99, 2.0}, 1e-3, -1e-2, {}},
                    {4.0, 0.5, "tail line tail", {20.0, 2.0, 0.5}, {20.0, 2.0, 2.0}, -1e-9, 0.0, {}}};
  opinion.states[0].meshes = {{0.1, 30, 7, 10.5, 0.9}, {0.05, 60, 6, 10.25, 0.95}};
  const std::string table = precision::to_csv(opinion);
  BOOST_TEST(table.find("\n2,0.25,10,10.01,0.001,1,0.99,-0.01,0.5,2,tail line tail,"
                        "0.1:30:10.5:0.9 0.05:60:10.25:0.95\n") != std::string::npos);
  const std::string text = precision::to_text(opinion);
  BOOST_TEST(text.find("1 of 2 states agree to 3e-04 in R_tot and 1e-02") != std::string::npos);
  BOOST_TEST(text.find("1.0e-03 (T = 2, R/r = 3) and 1.0e-02 (T = 2, R/r = 3)") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
