// Ctrl-C and full disks.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "regression/coil_run.hpp"
#include "support/csv.hpp"
#include "support/interrupt_program.hpp"

using namespace windlass::test;
namespace fs = std::filesystem;

BOOST_AUTO_TEST_SUITE(interruptions)

BOOST_AUTO_TEST_CASE(interrupted_runs_stay_readable) {
  const TemporaryFolder folder;
  const Words endless =
      planar("continue", {"--set", "continuation.step=1e-4", "--set", "continuation.step_max=1e-4", "--set",
                          "continuation.max_points=1000000", "--out", "run", "--quiet"});
  // As soon as there are points, however long that takes on a machine that is busy with other things.
  const auto begun = [&] {
    const std::string rows = slurp(folder.path() / "run" / "branches.csv");
    return std::count(rows.begin(), rows.end(), '\n') > 3;
  };
  const Outcome outcome = interrupt_program(endless, folder.path(), SIGINT, begun);
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
  BOOST_TEST(outcome.status == 2);
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

BOOST_AUTO_TEST_CASE(pictures_are_whole_or_an_error) {
  const TemporaryFolder folder;
  make_run(folder);
  // Room for the data, 20 kB, not for the picture, 100 kB; gnuplot itself says nothing.
  const Outcome outcome =
      run_program({"plot", "run", "--format", "png"}, folder.path(), "eval \"trap '' XFSZ; ulimit -f 40\";");
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(contains(outcome.err, "windlass: cannot write run/plots/diagram.png"), outcome.err);
}

BOOST_AUTO_TEST_CASE(commands_that_only_read_stop_at_once) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path plots = folder.path() / "run" / "plots";
  const Outcome outcome = interrupt_program({"plot", "run"}, folder.path(), SIGINT,
                                            [&] { return fs::exists(plots / "diagram.gp"); });
  BOOST_TEST(outcome.status == 130);
  BOOST_TEST(contains(outcome.err, "windlass: interrupted"), outcome.err);
  BOOST_TEST(!fs::exists(plots / "rod-1-1.gp"));  // the next picture was not begun
}

BOOST_AUTO_TEST_CASE(interrupted_spectra_are_kept) {
  const TemporaryFolder folder;
  make_run(folder, {"--set", "continuation.step_max=0.01", "--no-eigenvalues"});
  Table table;
  // Seconds of work; a machine busy with other things may need longer for the first point.
  for (int milliseconds = 100; milliseconds < 20000; milliseconds *= 2) {
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = interrupt_program(
        {"stability", "run", "--eigenvalues", "30"}, folder.path(), SIGINT,
        [&] { return std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(milliseconds); });
    BOOST_TEST(outcome.status == 130);
    table = read_csv(folder.path() / "run" / "branches.csv");
    BOOST_REQUIRE(table.rows.size() > 300u);
    if (!table.rows.front().at("eigenvalue_1").empty()) break;
  }
  BOOST_TEST(!table.rows.front().at("eigenvalue_1").empty());
  BOOST_TEST(table.rows.back().at("eigenvalue_1").empty());
  const Outcome rest = run_program({"stability", "run", "1-2"}, folder.path());
  BOOST_TEST(rest.status == 0, rest.err);
}

BOOST_AUTO_TEST_SUITE_END()
