// A cylinder that slides through a rod on a plate that ends.

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "regression/sliding.hpp"
#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

BOOST_AUTO_TEST_SUITE(sliding_beside_edge)

BOOST_AUTO_TEST_CASE(a_plate_ends_at_its_outer_edge) {
  // The state without friction's moment touches the plate with one tail: the same of a plate that reaches there, though with less
  // friction its edge holds the tail. Meshes follow the way: 1e-9 of model.tolerance.
  const nlohmann::json endless = solved(on_touches({}));
  const nlohmann::json wide = solved(on_touches({"plate.outer_radius=3"}));
  const nlohmann::json narrow = solved(on_touches({"plate.outer_radius=1.05"}));
  BOOST_REQUIRE(endless["states"].size() == 2u);
  BOOST_REQUIRE(wide["states"].size() == 2u);
  for (const char* key : {"F0", "R_tot", "energy"})
    BOOST_TEST(std::abs(wide["states"][1][key].get<double>() / endless["states"][1][key].get<double>() -
                        1.0) < 1e-9);
  // A plate as narrow as this holds no tail at this friction.
  BOOST_REQUIRE(narrow["states"].size() == 1u);
  BOOST_TEST(narrow["states"][0] == endless["states"][0]);
  const TemporaryFolder folder;
  const Outcome pull = run_program(sliding("pull", {"plate.outer_radius=3"}), folder.path());
  BOOST_TEST(pull.status == 1);
  BOOST_TEST(pull.err.find("plate.outer_radius") != std::string::npos, pull.err);
}

BOOST_AUTO_TEST_CASE(a_tail_bends_over_the_edge_of_the_plate) {
  // Followed down, the touch of the plate wanders outward to the edge, and the branch turns on it; a thin rod, and a thick one whose
  // centre line passes the edge on a torus. All states are certified: balance, the edge's force normal to the rod, no place inside.
  for (const char* radius : {"rod.radius=0", "rod.radius=0.05"}) {
    const TemporaryFolder folder;
    const std::string run = (folder / "run").string();
    const auto points =
        followed(run, on_touches({"plate.outer_radius=1.22", radius, "cylinder.friction_couple=false",
                                  "continuation.from=0.3", "continuation.to=0.22"}));
    BOOST_REQUIRE(!points.empty());
    BOOST_TEST(points[0]["before"] == "tail touch gap touch gap touch:2 tail");
    BOOST_TEST(points[0]["after"] == "tail touch gap touch gap touch:3 tail");
    // Up to the edge the plate is the endless one, whose touch is 1.22 away there, however thick the rod.
    BOOST_TEST(std::abs(points[0]["parameter"].get<double>() - 0.27107228246) < 1e-9);
    const Table table = read_csv(std::filesystem::path(run) / "branches.csv");
    for (const auto& row : table.rows) {
      BOOST_TEST(std::abs(std::stod(row.at("F0")) / (0.32 * std::stod(row.at("R_tot"))) - 1.0) < 1e-9);
      BOOST_TEST(std::abs(std::stod(row.at("plate_force")) / std::stod(row.at("F0")) - 1.0) < 1e-9);
    }
    BOOST_TEST(table.rows.back().at("topology") == "tail touch gap touch gap touch:3 tail");
  }
  // As the friction grows the other way round: from the edge to the plate.
  const TemporaryFolder folder;
  const auto points =
      followed((folder / "run").string(),
               on_touches({"plate.outer_radius=1.22", "continuation.parameter=cylinder.friction",
                           "continuation.from=0.2", "continuation.to=0.3"}));
  BOOST_REQUIRE(!points.empty());
  BOOST_TEST(points.back()["before"] == "tail touch gap touch gap touch:3 tail");
  BOOST_TEST(points.back()["after"] == "tail touch gap touch gap touch:2 tail");
}

BOOST_AUTO_TEST_CASE(a_sharp_edge_is_the_limit_of_a_round_one) {
  // F0 with the edge's radius, which the rod's is: it approaches that of the thin rod linearly, the edge moves the contact by O(r).
  const auto force = [](const char* radius) {
    const nlohmann::json state = solved(on_touches(
        {"plate.outer_radius=1.22", "cylinder.friction=0.2", radius, "cylinder.friction_couple=false"}));
    for (const auto& one : state["states"])
      if (one["topology"].get<std::string>().find("touch:3") != std::string::npos)
        return one["F0"].get<double>();
    BOOST_FAIL("no state on the edge");
    return 0.0;
  };
  const double sharp = force("rod.radius=0"), half = force("rod.radius=0.005"),
               whole = force("rod.radius=0.01");
  BOOST_TEST(std::abs(half / sharp - 1.0) < 0.02);
  BOOST_TEST(half != sharp);
  BOOST_TEST(std::abs((whole - sharp) / (half - sharp) - 2.0) < 0.1);  // but for the next order, r
  // The moment of the friction is followed in the radius, which the edge has, too: not for a rod on the edge, and it says so.
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      sliding("solve", on_touches({"plate.outer_radius=1.22", "cylinder.friction=0.2", "rod.radius=0.01"})),
      folder.path());
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.err.find("plate.outer_radius") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
