// When a pull is on its plateau, the limit over meshes, and which steady state it is.
#include "windlass/pull/outcome.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace windlass;
using pull::MeshOutcome;
using pull::Plateau;
using pull::Row;

namespace {

/// F = 2 − exp(−U/scale), everything slipping and at rest.
std::vector<Row> rows_of(double reach, double scale) {
  std::vector<Row> rows;
  for (double U = 0.1; U < reach; U += 0.1) {
    Row row;
    row.displacement = U, row.step = 0.1;
    row.at.drag = 2.0 - std::exp(-U / scale), row.at.R_tot = 6.0;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pull_outcomes)

BOOST_AUTO_TEST_CASE(a_plateau_is_level_slips_and_rests) {
  const pull::Options options;
  BOOST_TEST(!pull::plateau({}, options));
  BOOST_TEST(!pull::plateau(rows_of(1.0, 1.0), options));
  std::vector<Row> rows = rows_of(8.0, 0.5);
  const auto level = pull::plateau(rows, options);
  BOOST_REQUIRE(level.has_value());
  BOOST_TEST(std::abs(level->drag - 2.0) < 1e-4);
  BOOST_TEST(std::abs(level->R_tot - 6.0) < 1e-12);
  // An extremum of F while the rod moves is none, nor is one where some of it sticks.
  std::vector<Row> moving = rows, sticking = rows, jumped = rows;
  moving[moving.size() - 3].at.moved = 0.05;
  sticking[sticking.size() - 3].at.sticking = 0.1;
  jumped[jumped.size() - 3].jumped = true;
  for (const auto& other : {moving, sticking, jumped}) BOOST_TEST(!pull::plateau(other, options));
}

BOOST_AUTO_TEST_CASE(the_limit_is_exact_for_the_cube_of_h) {
  std::vector<MeshOutcome> meshes;
  for (const double h : {0.2, 0.14, 0.1})
    meshes.push_back({h, {}, Plateau{1.3 - 4.0 * h * h * h, 5.0 + h * h * h}});
  auto limit = pull::limit_of(meshes);
  BOOST_REQUIRE(limit.has_value());
  BOOST_TEST(std::abs(limit->at.drag - 1.3) < 1e-13);
  BOOST_TEST(std::abs(limit->at.R_tot - 5.0) < 1e-13);
  BOOST_TEST(limit->misfit < 1e-13);
  meshes[1].at->drag *= 0.9;  // came to another state
  limit = pull::limit_of(meshes);
  BOOST_REQUIRE(limit.has_value());
  BOOST_TEST(!limit->one_state());
  meshes[1].at.reset();
  BOOST_TEST(!pull::limit_of(meshes).has_value());
}

BOOST_AUTO_TEST_CASE(the_nearest_state_is_selected_where_force_and_contact_agree) {
  std::vector<equilibrium::StateSummary> states(2);
  states[0].F0 = 1.0, states[0].R_tot = 3.0;
  states[1].F0 = 1.5, states[1].R_tot = 4.0;
  const auto chosen = pull::selected({0.7502, 2.0008}, states, 2.0);  // in a unit of force of two
  BOOST_REQUIRE(chosen.has_value());
  BOOST_TEST(chosen->state.value() == 1u);
  BOOST_TEST(std::abs(chosen->difference - 0.0004 / 1.5) < 1e-12);
  const auto none = pull::selected({1.4, 4.0}, states, 1.0);
  BOOST_TEST(!none->state.has_value());
  BOOST_TEST(none->nearest == 1u);
  BOOST_TEST(!pull::selected({1.5, 3.0}, states, 1.0)->state.has_value());  // the force alone is no proof
  BOOST_TEST(!pull::selected({1.5, 3.0}, {}, 1.0).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
