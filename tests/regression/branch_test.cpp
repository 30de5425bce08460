// Branches and diagrams, as a user makes them; restarts.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "regression/coil_run.hpp"
#include "support/csv.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;
namespace fs = std::filesystem;

BOOST_AUTO_TEST_SUITE(branches)

BOOST_AUTO_TEST_CASE(a_branch_is_on_disk_and_on_the_closed_form) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path run = folder.path() / "run";
  for (const char* file : {"scene.toml", "run.json", "branches.csv", "special_points.json", "points.h5"})
    BOOST_TEST(fs::exists(run / file), file);
  const auto info = nlohmann::json::parse(slurp(run / "run.json"));
  BOOST_TEST(info["status"] == "finished");
  for (const char* key : {"points", "continuation", "stability", "total"})
    BOOST_TEST(info["timings"].contains(key), key);
  const Table table = read_csv(run / "branches.csv");
  const Words expected = {"branch",
                          "point",
                          "label",
                          "type",
                          "T",
                          "phi",
                          "R_tot",
                          "phi_star",
                          "tilt",
                          "z_span",
                          "energy",
                          "self_distance",
                          "self_force",
                          "plate_force",
                          "F0",
                          "travel",
                          "index",
                          "eigenvalue_1",
                          "ds",
                          "newton_iterations",
                          "error_estimate",
                          "topology"};
  BOOST_TEST(table.header == expected, boost::test_tools::per_element());
  BOOST_REQUIRE(table.rows.size() > 5u);
  BOOST_TEST(info["timings"]["points"] == table.rows.size());
  BOOST_TEST(std::stod(table.rows.front().at("T")) == 5.0);
  BOOST_TEST(std::stod(table.rows.back().at("T")) == 0.55, boost::test_tools::tolerance(1e-12));
  for (const auto& row : table.rows) {
    const double t = std::stod(row.at("T"));
    BOOST_TEST_CONTEXT("T = " << t) {
      // The free tails are 12.5 long or more: exp(-2 sqrt(0.55) 12.5) = 1e-8 away from the closed form at the slack end.
      BOOST_TEST(relative(std::stod(row.at("R_tot")), capstan::total_force(t, full_turn)) < 1e-7);
      BOOST_TEST(std::stod(row.at("error_estimate")) < 1e-8);
      BOOST_TEST(row.at("topology") == "tail line tail");
      BOOST_TEST(row.at("index") == "0");
    }
  }
}

BOOST_AUTO_TEST_CASE(an_existing_folder_is_never_overwritten_unasked) {
  const TemporaryFolder folder;
  make_run(folder);
  const std::string before = slurp(folder.path() / "run" / "branches.csv");
  const Words again = planar("continue", {"--set", "continuation.to=2", "--out", "run"});
  const Outcome refused = run_program(again, folder.path());
  BOOST_TEST(refused.status == 1);
  BOOST_TEST(contains(refused.err, "exists and is not empty; use --force"), refused.err);
  BOOST_TEST(slurp(folder.path() / "run" / "branches.csv") == before);
  BOOST_TEST(run_program(again + Words{"--force"}, folder.path()).status == 0);
  BOOST_TEST(std::stod(read_csv(folder.path() / "run" / "branches.csv").rows.back().at("T")) == 2.0,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(contact_events_are_located_and_passed) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(planar("continue", {"--out", "run"}), folder.path());  // down to T = 0.1
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto special = nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json"));
  BOOST_REQUIRE(special.size() == 2u);
  BOOST_TEST(special[0]["type"] == "contact");
  BOOST_TEST(special[0]["before"] == "tail line tail");
  BOOST_TEST(special[0]["after"] == "tail touch gap touch tail");
  // Both limits are those of infinite tails up to exp(-2 sqrt(T) L_tail), L_tail = 13.
  BOOST_TEST(std::abs(special[0]["T"].get<double>() - 0.5) < 1e-7);
  const double width = std::sqrt(2.0) - std::asinh(1.0);  // of the free loop, to each side, times sqrt(T)
  BOOST_TEST(special[1]["type"] == "contact");
  BOOST_TEST(std::abs(special[1]["T"].get<double>() - width * width) < 1e-4);
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
}

BOOST_AUTO_TEST_CASE(a_diagram_holds_the_branch_that_leaves_the_plane) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"diagram", coil(), "--out", "run"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto special = nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json"));
  BOOST_REQUIRE(!special.empty());
  BOOST_TEST(special[0]["type"] == "branch_point");
  BOOST_TEST(special[0]["mode"]["plane"] == "out");
  BOOST_TEST(special[0]["mode"]["parity"] == "even");
  // The program's own value, kept: no other source gives it to more digits.
  BOOST_TEST(std::abs(special[0]["T"].get<double>() - 1.285936842) < 1e-7);
  bool helical = false;
  for (const auto& row : read_csv(folder.path() / "run" / "branches.csv").rows) {
    helical =
        helical || (row.at("branch") == "2" && std::stod(row.at("z_span")) > 1.0 && row.at("index") == "0");
    // The index counts pivots of the condensed chain, the eigenvalue is SLEPc's: two ways to the same stability.
    if (row.at("type") == "regular")
      BOOST_TEST((std::stod(row.at("eigenvalue_1")) < 0.0) == (row.at("index") != "0"), row.at("T"));
  }
  BOOST_TEST(helical);
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
}

BOOST_AUTO_TEST_CASE(any_stored_point_restarts_a_run) {
  const TemporaryFolder folder;
  make_run(folder);
  const Table first = read_csv(folder.path() / "run" / "branches.csv");
  const Outcome outcome =
      run_program({"continue", "run", "1-4", "--set", "continuation.to=1", "--out", "again"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const Table second = read_csv(folder.path() / "again" / "branches.csv");
  BOOST_TEST(std::stod(second.rows.front().at("T")) == std::stod(first.rows.at(3).at("T")));
  BOOST_TEST(relative(std::stod(second.rows.front().at("R_tot")), std::stod(first.rows.at(3).at("R_tot"))) <
             1e-10);
  BOOST_TEST(std::stod(second.rows.back().at("T")) == 1.0, boost::test_tools::tolerance(1e-12));
  const Outcome unknown = run_program({"continue", "run", "BP7", "--out", "other"}, folder.path());
  BOOST_TEST(unknown.status == 1);
  BOOST_TEST(contains(unknown.err, "there is no stored point \"BP7\""), unknown.err);
  BOOST_TEST(!fs::exists(folder.path() / "other"));
}

BOOST_AUTO_TEST_SUITE_END()
