// A clove hitch that a cylinder slides through, held back by a plate, as a user has it computed.

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/certified_run.hpp"
#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

std::vector<std::string> hitch(const std::string& command, const std::vector<std::string>& settings) {
  std::vector<std::string> out = {command, shipped_scene("clove-hitch-plate")};
  for (const std::string& setting : settings) out.insert(out.end(), {"--set", setting});
  return out;
}

nlohmann::json dragged_hitch(const std::vector<std::string>& settings) {
  std::vector<std::string> command = hitch("solve", settings);
  command.insert(command.end(), {"--json", "--quiet"});
  const TemporaryFolder folder;
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

double value_in(const nlohmann::json& state, const char* key) { return state[key].get<double>(); }

}  // namespace

BOOST_AUTO_TEST_SUITE(sliding_knots)

BOOST_AUTO_TEST_CASE(little_friction_drags_with_mu_R_tot_of_the_knot_without) {
  // F0/mu is smooth in mu, so that 2 F0(mu)/mu − F0(2mu)/2mu is R_tot of the knot at mu = 0 to O(mu²), 1e-7 relative here. That
  // knot is computed on another chain, half of it, with neither plate nor friction.
  const std::string tension = "load.tension=0.3";
  const double still = value_in(dragged_hitch({tension, "cylinder.sliding=none", "plate.height=9"}), "R_tot");
  const auto drag = [&](double mu) {
    return value_in(dragged_hitch({tension, "cylinder.friction=" + std::to_string(mu)}), "F0") / mu;
  };
  constexpr double mu = 2.5e-4;
  BOOST_TEST(std::abs((2.0 * drag(mu) - drag(2.0 * mu)) / still - 1.0) < 1e-6);
  BOOST_TEST(std::abs(drag(mu) / still - 1.0) > 1e-5);  // what the shape changes by is seen
}

BOOST_AUTO_TEST_CASE(the_plate_carries_what_the_cylinder_drags_with) {
  for (const char* travel : {"blocked", "free"}) {
    const nlohmann::json state = dragged_hitch({"load.tension=0.3", std::string("ends.travel=") + travel});
    const double drag = value_in(state, "F0"), plate = state["plate"]["force"].get<double>();
    BOOST_TEST(std::abs(plate / drag - 1.0) < 1e-10);
    BOOST_TEST(drag <
               0.32 *
                   1.38175461099);  // of the knot without friction: README, from the clove hitch's own scene
    BOOST_TEST(state["stability"]["index"] == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_dragged_hitch_is_followed_through_changes_of_contact) {
  // A line on the plate, its end at a touch of the cylinder, that touch and the lines beside it in the plate: all of these come
  // between these tensions, upward on the way to the first state, then downward. Every point is integrated again, with the
  // balance along the axis among the checks.
  const TemporaryFolder folder;
  const Table table =
      certified_run(hitch("continue", {"continuation.from=0.49", "continuation.to=0.3"}), folder);
  BOOST_TEST(table.rows.back().at("T") == "0.3");
  for (const auto& row : table.rows)
    BOOST_TEST(std::abs(std::stod(row.at("plate_force")) / std::stod(row.at("F0")) - 1.0) < 1e-10);
  BOOST_TEST(table.rows.front().at("topology") != table.rows.back().at("topology"));
}

BOOST_AUTO_TEST_CASE(a_line_between_strands_closes_before_a_fold) {
  // R/r = 1. Two lines of the same two strands grow towards each other and are one from T = 0.857 on; then comes a fold. Were the
  // gap followed below the spacing of the lines' touches the branch would turn there, and go back as it came.
  const TemporaryFolder folder;
  const Table table = certified_run(hitch("continue", {"rod.radius=0.5", "continuation.from=0.85",
                                                       "continuation.to=0.9", "continuation.max_points=50"}),
                                    folder);
  const auto fold = std::find_if(table.rows.begin(), table.rows.end(),
                                 [](const auto& row) { return row.at("label") == "F1"; });
  BOOST_REQUIRE((fold != table.rows.end()));
  // From the other side, on a branch that has been through six more events, 0.8658725406; the touches' share is less than this.
  BOOST_TEST(std::abs(std::stod(fold->at("T")) - 0.86587254) < 2e-8);
  BOOST_TEST(table.rows.front().at("index") == "0");
  BOOST_TEST(table.rows.back().at("index") == "1");
}

BOOST_AUTO_TEST_CASE(a_plate_without_friction_leaves_the_knot_what_it_is) {
  // It is as much in the knot's way as the knot may move along the axis: no force, the same R_tot to the error of the meshes.
  const nlohmann::json free = dragged_hitch({"cylinder.sliding=none", "plate.height=9"}),
                       below = dragged_hitch({"cylinder.sliding=none", "plate.height=-0.5"}),
                       above =
                           dragged_hitch({"cylinder.sliding=none", "plate.height=0.5", "plate.side=below"});
  for (const nlohmann::json* state : {&below, &above}) {
    BOOST_TEST(std::abs(value_in(*state, "R_tot") / value_in(free, "R_tot") - 1.0) < 1e-10);
    BOOST_TEST((*state)["plate"]["force"] == 0.0);
  }
  const auto height = [](const nlohmann::json& state) {
    return state["contact"]["joints"][5]["z"].get<double>();
  };
  BOOST_TEST(height(below) < -0.5);
  BOOST_TEST(height(above) > 0.5);
}

BOOST_AUTO_TEST_CASE(knots_that_cannot_slide_are_refused) {
  const TemporaryFolder folder;
  for (const auto& [setting, status, why] : {std::tuple{"plate.side=below", 1, "plate.side"},
                                             {"cylinder.friction=0", 1, "cylinder.friction"},
                                             {"cylinder.friction_couple=true", 1, "cylinder.friction_couple"},
                                             {"model.symmetry=half_turn", 1, "model.symmetry"},
                                             {"ends.kind=clamped", 1, "ends.kind"},
                                             {"plate.outer_radius=1.01", 2, "plate.outer_radius"}}) {
    const Outcome outcome = run_program(hitch("solve", {setting, "load.tension=0.3"}), folder.path());
    BOOST_TEST(outcome.status == status);
    BOOST_TEST(outcome.err.find(why) != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
