// Runs that start from a singular point of another: the branch that went through it is taken up beside it.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/csv.hpp"

using namespace windlass::test;

BOOST_AUTO_TEST_SUITE(restarts)

BOOST_AUTO_TEST_CASE(a_branch_goes_on_from_its_branch_point) {
  const TemporaryFolder folder;
  const std::string scene = shipped_scene("capstan-2pi");
  const std::vector<std::string> first{
      "continue", scene, "--no-eigenvalues", "--set", "continuation.to=1.2", "--out", "first", "--quiet"};
  BOOST_REQUIRE(run_program(first, folder.path()).status == 0);
  const auto special = nlohmann::json::parse(slurp(folder.path() / "first" / "special_points.json"));
  BOOST_REQUIRE(special.size() == 1u);
  const double transition = special[0]["T"];
  for (const std::string goal : {"0.6", "3"}) {
    const Outcome outcome = run_program({"continue", "first", "B1", "--no-eigenvalues", "--set",
                                         "continuation.to=" + goal, "--out", "to-" + goal, "--quiet"},
                                        folder.path());
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Table branch = read_csv(folder.path() / ("to-" + goal) / "branches.csv");
    BOOST_TEST(std::abs(std::stod(branch.rows.front().at("T")) - transition) < 1e-3);
    BOOST_TEST(std::stod(branch.rows.back().at("T")) == std::stod(goal));
    // The flat branch, unstable below the transition, stable above: not an arm that leaves it.
    BOOST_TEST(std::stod(branch.rows.back().at("z_span")) < 1e-9);
    BOOST_TEST(branch.rows.back().at("index") == (goal == "3" ? "0" : "1"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
