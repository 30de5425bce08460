// A strut between walls as a user meets it: a branch through its contacts, certificates, pictures, a restart, one state.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;
using nlohmann::json;

BOOST_AUTO_TEST_SUITE(wall_runs)

BOOST_AUTO_TEST_CASE(the_shipped_strut_touches_lies_down_and_buckles) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"continue", shipped_scene("strut-between-walls"), "--out", "run"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json specials = json::parse(slurp(folder.path() / "run" / "special_points.json"));
  std::vector<std::string> after;
  for (const json& point : specials)
    if (point["type"] == "contact") after.push_back(point["after"]);
  BOOST_TEST_REQUIRE(after.size() >= 3u);
  BOOST_TEST(after[0] == "tail touch:2 tail");
  BOOST_TEST(after[1] == "tail line:2 tail");
  BOOST_TEST(after[2] == "tail touch:2 gap touch:2 tail");
  for (const auto& row : read_csv(folder.path() / "run" / "branches.csv").rows)
    BOOST_TEST(!row.at("index").empty());
  const Outcome verified = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
  BOOST_TEST(run_program({"plot", "run", "--format", "svg"}, folder.path()).status == 0);
  const Outcome report = run_program({"report", "run"}, folder.path());
  BOOST_TEST(report.status == 0, report.err);
  // A stored point on the wall starts another branch: its obstacles come back with it.
  const Outcome restarted = run_program(
      {"continue", "run", "E3", "--set", "continuation.to=0.0105", "--out", "more"}, folder.path());
  BOOST_TEST(restarted.status == 0, restarted.err);
  BOOST_TEST(run_program({"verify", "more"}, folder.path()).status == 0);
}

// A round rod that lies on the wall may leave the plane, and its clamps with it: such an arm is named, and
// nothing of it is stored.
BOOST_AUTO_TEST_CASE(states_that_leave_their_clamps_are_not_stored) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"diagram", shipped_scene("strut-between-walls"), "--set", "rod.bending_stiffness_2=1",
                   "--set", "continuation.to=0.01", "--no-eigenvalues", "--out", "run"},
                  folder.path());
  BOOST_TEST(outcome.status == 0);
  BOOST_TEST(
      outcome.out.find(
          "no arm: B3: direction 1 (+): a clamped end whose rod lies on an obstacle leaves its clamp") !=
          std::string::npos,
      outcome.out);
  const Outcome verified = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
}

BOOST_AUTO_TEST_CASE(one_state_on_the_wall) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"solve", shipped_scene("strut-between-walls"), "--set", "ends.shortening=0.007", "--json"},
                  folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json answer = json::parse(outcome.out);
  BOOST_TEST(answer["stability"]["index"] == 0);
  double sum = 0.0;
  bool touched = false;
  for (const json& joint : answer["contact"]["joints"]) {
    sum += joint["force"].get<double>();
    if (!joint.contains("obstacle")) continue;
    touched = true;
    BOOST_TEST(std::abs(std::abs(joint["r"][1].get<double>()) - 0.05) < 1e-9);
  }
  BOOST_TEST(touched);
  BOOST_TEST(answer["R_tot"].get<double>() == sum, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_SUITE_END()
