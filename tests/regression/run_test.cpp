// Whole runs, as a user makes them: solve, continue, restart, verify, stability, plot; interrupted and damaged ones.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.hpp"
#include "windlass/output/point_store.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;
namespace fs = std::filesystem;

namespace {

constexpr double full_turn = 2.0 * M_PI;

/// The rod of length 30, a full turn around the cylinder.
std::string coil() { return std::string(std::getenv("WINDLASS_SCENES")) + "/capstan-2pi.toml"; }

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words planar(const std::string& command, const Words& more = {}) {
  return Words{command, coil(), "--set", "model.kind=planar"} + more;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double relative(double value, double exact) { return std::abs(value / exact - 1.0); }

Words split(const std::string& line) {
  Words words;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

struct Table {
  Words header;
  std::vector<std::map<std::string, std::string>> rows;
};

Table read_csv(const fs::path& path) {
  std::istringstream text(slurp(path));
  Table table;
  std::string line;
  if (std::getline(text, line)) table.header = split(line);
  while (std::getline(text, line)) {
    const Words words = split(line);
    auto& row = table.rows.emplace_back();
    for (std::size_t k = 0; k < words.size() && k < table.header.size(); ++k) row[table.header[k]] = words[k];
  }
  return table;
}

/// A short branch, T from 5 to 0.55, in `folder`/run.
void make_run(const TemporaryFolder& folder) {
  const Outcome outcome =
      run_program(planar("continue", {"--set", "continuation.to=0.55", "--out", "run"}), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
}

void truncate(const fs::path& path) { fs::resize_file(path, fs::file_size(path) / 2); }

}  // namespace

BOOST_AUTO_TEST_SUITE(runs)

BOOST_AUTO_TEST_CASE(solve_prints_what_the_contract_names) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(planar("solve", {"--set", "load.tension=1", "--json"}), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key :
       {"parameters", "model", "model_reason", "converged", "newton_iterations", "R_tot", "phi_star", "tilt",
        "z_span", "energy", "contact", "stability", "invariants", "error_estimate", "mesh", "seconds"})
    BOOST_TEST(json.contains(key), key);
  BOOST_TEST(!json.contains("F0"));  // the scene has no friction
  BOOST_TEST(json["parameters"]["T"] == 1.0);
  BOOST_TEST(json["parameters"]["phi"].get<double>() == full_turn);
  BOOST_TEST(json["model"] == "planar");
  BOOST_TEST(json["converged"].get<bool>());
  BOOST_TEST(relative(json["R_tot"], capstan::total_force(1.0, full_turn)) < 1e-8);
  BOOST_TEST(relative(json["phi_star"], capstan::phi_star(1.0, full_turn)) < 1e-8);
  BOOST_TEST(json["error_estimate"].get<double>() < 1e-8);
  BOOST_TEST(json["stability"]["index"] == 0);
  BOOST_TEST(!json["stability"]["degenerate"].get<bool>());
  for (const char* key : {"hamiltonian_drift", "axial_torque_drift", "force_residual"})
    BOOST_TEST(json["invariants"][key].get<double>() < 1e-8, key);
  const auto& contact = json["contact"];
  BOOST_TEST(contact["topology"] == "tail line tail");
  BOOST_REQUIRE(contact["arcs"].size() == 3u);
  BOOST_TEST(contact["arcs"][1]["kind"] == "line");
  // The whole rod, and its contact forces, are the sum of what is listed.
  BOOST_TEST(contact["arcs"][0]["s_begin"].get<double>() == -15.0);
  BOOST_TEST(contact["arcs"][2]["s_end"].get<double>() == 15.0);
  double sum = 0.0;
  for (const char* list : {"arcs", "joints"})
    for (const auto& part : contact[list]) sum += part["force"].get<double>();
  BOOST_TEST(relative(sum, json["R_tot"]) < 1e-12);
  BOOST_TEST(!fs::exists(folder.path() / "runs"));  // only --out makes a folder
}

BOOST_AUTO_TEST_CASE(infinite_length_equals_the_closed_form) {
  for (const char* tension : {"0.51", "5"}) {
    const std::string setting = std::string("load.tension=") + tension;
    const Outcome outcome =
        run_program(planar("solve", {"--set", "rod.length=inf", "--set", setting, "--json"}));
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const auto json = nlohmann::json::parse(outcome.out);
    BOOST_TEST(relative(json["R_tot"], capstan::total_force(std::stod(tension), full_turn)) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(physical_scenes_have_units) {
  const std::string scene = std::string(std::getenv("WINDLASS_SCENES")) + "/capstan-vps-pom.toml";
  const Outcome outcome = run_program({"solve", scene, "--set", "model.kind=planar", "--json"});
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto json = nlohmann::json::parse(outcome.out);
  BOOST_TEST(json.contains("physical"));
  BOOST_TEST(relative(json["F0"], 0.32 * json["R_tot"].get<double>()) < 1e-12);
}

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
  const Words expected = {"branch",         "point",    "label",
                          "type",           "T",        "phi",
                          "R_tot",          "phi_star", "tilt",
                          "z_span",         "energy",   "index",
                          "eigenvalue_1",   "ds",       "newton_iterations",
                          "error_estimate", "topology"};
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

BOOST_AUTO_TEST_CASE(what_is_done_with_a_finished_run) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path run = folder.path() / "run";
  const Outcome certificate = run_program({"verify", "run", "--json"}, folder.path());
  BOOST_REQUIRE_MESSAGE(certificate.status == 0, certificate.err);
  const auto report = nlohmann::json::parse(certificate.out);
  BOOST_TEST(report["failed"] == 0);
  BOOST_TEST(report["checked"] == read_csv(run / "branches.csv").rows.size());

  const Outcome spectra = run_program({"stability", "run"}, folder.path());
  BOOST_TEST(spectra.status == 0, spectra.err);
  BOOST_TEST(contains(spectra.out, "1-1 "), spectra.out);
  BOOST_TEST(nlohmann::json::parse(slurp(run / "run.json"))["status"] == "finished");
  for (const auto& row : read_csv(run / "branches.csv").rows)
    BOOST_TEST(std::stod(row.at("eigenvalue_1")) > 0.0);

  const Outcome picture = run_program({"plot", "run", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(picture.status == 0, picture.err);
  BOOST_TEST(slurp(run / "plots" / "diagram.png").substr(1, 3) == "PNG");
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

BOOST_AUTO_TEST_CASE(damaged_run_folders_are_named) {
  const TemporaryFolder folder;
  make_run(folder);
  for (const char* file : {"points.h5", "run.json"}) {
    fs::copy(folder.path() / "run", folder.path() / "damaged", fs::copy_options::recursive);
    truncate(folder.path() / "damaged" / file);
    for (const char* command : {"verify", "stability", "plot"}) {
      const Outcome outcome = run_program({command, "damaged"}, folder.path());
      BOOST_TEST(outcome.status == 1, command);
      BOOST_TEST(
          contains(outcome.err, std::string("windlass: cannot read damaged/") + file + ": it is truncated"),
          outcome.err);
    }
    fs::remove_all(folder.path() / "damaged");
  }
}

BOOST_AUTO_TEST_CASE(damaged_points_fail_by_name) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path path = folder.path() / "run" / "points.h5";
  const auto stored = windlass::output::PointStore::read(path);
  windlass::output::PointStore damaged;
  for (std::size_t k = 0; k < stored.size(); ++k) {
    auto solution = stored.get(k);
    if (k == 4) solution.arcs[0].m(2, 3) += 1e-6;
    damaged.append(stored.keys()[k], solution);
  }
  damaged.write(path);
  const Outcome failed = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(failed.status == 3, failed.err);
  BOOST_TEST(contains(failed.out, "point 1-5 "), failed.out);
  BOOST_TEST(contains(failed.out, "FAILED arc_moment"), failed.out);
  BOOST_TEST(contains(failed.out, ", 1 failed"), failed.out);
  BOOST_TEST(run_program({"verify", "run", "--accept", "1e-4"}, folder.path()).status == 0);

  windlass::output::PointStore().write(path);  // as if it had been killed before its first point was stored
  const Outcome empty = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(empty.status == 1);
  BOOST_TEST(empty.err == "windlass: run: holds no points yet, so there is nothing to verify\n");
}

BOOST_AUTO_TEST_CASE(a_certificate_can_fail) {
  const TemporaryFolder folder;
  make_run(folder);
  // Moment-free ends are not clamped ones: at low tension their directions differ by 1e-4.
  const Outcome outcome = run_program({"verify", "run", "--set", "ends.kind=clamped"}, folder.path());
  BOOST_TEST(outcome.status == 3, outcome.err);
  BOOST_TEST(contains(outcome.out, "FAILED end_clamp"), outcome.out);
}

BOOST_AUTO_TEST_CASE(rod_shorter_than_its_contact) {
  const Outcome outcome = run_program(planar("solve", {"--set", "rod.length=2"}));
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(contains(outcome.err, "rod.length = 2"), outcome.err);
  BOOST_TEST(contains(outcome.err, "the rod is shorter than its contact arc"), outcome.err);
}

BOOST_AUTO_TEST_CASE(no_equilibrium_in_contact) {
  // The free loop is wider than the cylinder below T = 0.284.
  const Outcome outcome = run_program(planar("solve", {"--set", "load.tension=0.2", "--json"}));
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.out == "");
  BOOST_TEST(contains(outcome.err, "windlass: no equilibrium in contact exists at load.tension = 0.2"),
             outcome.err);
  BOOST_TEST(contains(outcome.err, "lifts off the cylinder at 0.2839"), outcome.err);
}

BOOST_AUTO_TEST_CASE(interrupted_runs_stay_readable) {
  const TemporaryFolder folder;
  const Words endless =
      planar("continue", {"--set", "continuation.step=1e-4", "--set", "continuation.step_max=1e-4", "--set",
                          "continuation.max_points=1000000", "--out", "run", "--quiet"});
  // A long branch, so that the signal surely meets it; in the foreground, or timeout would signal twice.
  const Outcome outcome =
      run_program(endless, folder.path(), "timeout --foreground --preserve-status -s INT 0.6");
  BOOST_TEST(outcome.status == 130, outcome.err);
  const auto info = nlohmann::json::parse(slurp(folder.path() / "run" / "run.json"));
  BOOST_TEST(info["status"] == "interrupted");
  const Table table = read_csv(folder.path() / "run" / "branches.csv");
  BOOST_REQUIRE(!table.rows.empty());
  BOOST_TEST(info["timings"]["points"] == table.rows.size());
  const auto& last = table.rows.back();
  const Outcome restart =
      run_program({"continue", "run", last.at("branch") + "-" + last.at("point"), "--set",
                   "continuation.to=4", "--set", "continuation.step_max=1", "--out", "rest"},
                  folder.path());
  BOOST_TEST(restart.status == 0, restart.err);
}

BOOST_AUTO_TEST_CASE(a_full_disk_is_an_answer_and_leaves_what_was_there) {
  const TemporaryFolder folder;
  const Words words = planar("continue", {"--save-every", "0", "--out", "run"});
  const Outcome outcome = run_program(words, folder.path(), "eval \"trap '' XFSZ; ulimit -f 200\";");
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(contains(outcome.err, "windlass: cannot write run/points.h5"), outcome.err);
  BOOST_TEST(read_csv(folder.path() / "run" / "branches.csv").rows.size() > 3u);
  const Outcome stored = run_program({"verify", "run"}, folder.path());  // the points committed so far
  BOOST_TEST(stored.status == 0, stored.err);
  // With room again it goes on to what it would have become.
  BOOST_TEST(run_program(words + Words{"--resume"}, folder.path()).status == 0);
  BOOST_TEST(run_program(planar("continue", {"--out", "whole"}), folder.path()).status == 0);
  BOOST_TEST(slurp(folder.path() / "run" / "special_points.json") ==
             slurp(folder.path() / "whole" / "special_points.json"));
}

BOOST_AUTO_TEST_SUITE_END()
