#include "windlass/output/stable_state.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

namespace {

using namespace windlass;

output::BranchRow row(int branch, int point, double T, double R_tot, int index,
                      const std::string& label = "") {
  output::BranchRow row;
  row.branch = branch, row.point = point, row.T = T, row.R_tot = R_tot, row.index = index, row.label = label;
  return row;
}

/// Branch 1 is stable above T = 2, branch 2 from there down to 1 and, beyond a fold, again between 1.2 and 1.5.
output::Run rows_only() {
  output::Run run;
  run.rows = {row(1, 1, 4.0, 8.0, 0), row(1, 2, 3.0, 6.0, 0),  row(1, 3, 2.0, 4.0, 1, "B1"),
              row(1, 4, 1.0, 2.0, 1), row(2, 1, 1.99, 4.0, 0), row(2, 2, 1.35, 3.0, 0),
              row(2, 3, 1.3, 2.9, 0), row(2, 4, 1.0, 2.0, 0),  row(2, 5, 1.2, 1.0, 1),
              row(2, 6, 1.3, 1.1, 0), row(2, 7, 1.5, 1.2, 0)};
  return run;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stable_states)

BOOST_AUTO_TEST_CASE(stretches_come_from_high_tension_down) {
  const auto stretches = output::stable_stretches(rows_only());
  BOOST_REQUIRE(stretches.size() == 3u);
  const double bounds[][2] = {{2.0, 4.0}, {1.0, 1.99}, {1.3, 1.5}};
  for (int k = 0; k < 3; ++k) {
    BOOST_TEST(stretches[k].lowest == bounds[k][0]);
    BOOST_TEST(stretches[k].highest == bounds[k][1]);
  }
}

// No solution is stored, so that nothing can be continued: what is left is interpolation, on the stretch of the rod that
// was slackened from high tension, and only between near points.
BOOST_AUTO_TEST_CASE(forces_are_interpolated_between_near_points_and_say_so) {
  const auto run = rows_only();
  const auto force = output::stable_contact_force(run, {}, 1.32);
  BOOST_REQUIRE(force.has_value());
  BOOST_TEST((force->source == output::ForceSource::interpolated));
  const double slope = std::log(3.0 / 2.9) / std::log(1.35 / 1.3);
  BOOST_TEST(force->R_tot == 2.9 * std::pow(1.32 / 1.3, slope), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(!output::stable_contact_force(run, {}, 3.5));  // its neighbours are too far apart
  BOOST_TEST(!output::stable_contact_force(run, {}, 0.5));
  BOOST_TEST(!output::stable_contact_force(run, {}, 5.0));
}

BOOST_AUTO_TEST_SUITE_END()
