// A sweep over a grid: the same tables on one rank, on two, and after a kill.
#include <signal.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/csv.hpp"
#include "support/interrupt_program.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;
namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

std::string scene(const std::string& name) {
  return std::string(std::getenv("WINDLASS_SCENES")) + "/" + name;
}

/// Six flat states.
Words states(const std::string& out, const Words& more = {}) {
  Words words{"sweep",  scene("capstan-2pi.toml"),
              "--set",  "model.kind=planar",
              "--over", "load.angle=1 pi:2 pi:2",
              "--over", "load.tension=2:8:3:log",
              "--out",  out,
              "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Three diagrams with their flat and helical branches.
Words diagrams(const std::string& out, const Words& more = {}) {
  Words words{"sweep",  scene("capstan-2pi.toml"),       "--each", "diagram", "--set",  "continuation.to=0.6",
              "--over", "load.angle=1.5 pi,2 pi,2.5 pi", "--out",  out,       "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const char* const two_ranks = "mpirun --allow-run-as-root --oversubscribe --bind-to none -n 2";
bool have_mpirun() { return std::system("command -v mpirun > /dev/null 2>&1") == 0; }

}  // namespace

BOOST_AUTO_TEST_SUITE(sweeps)

BOOST_AUTO_TEST_CASE(the_table_holds_every_case_in_order) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(states("out"), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const Table table = read_csv(folder.path() / "out" / "sweep.csv");
  BOOST_REQUIRE(table.rows.size() == 6u);
  const char* const angles[] = {"1 pi", "2 pi"};
  const double tensions[] = {2.0, 4.0, 8.0};
  for (std::size_t k = 0; k < 6; ++k) {
    const double angle = (k < 3 ? 1.0 : 2.0) * M_PI, tension = tensions[k % 3];
    BOOST_TEST(table.rows[k].at("case") == std::to_string(k + 1));
    BOOST_TEST(table.rows[k].at("load.angle") == angles[k / 3]);
    BOOST_TEST(std::abs(std::stod(table.rows[k].at("T")) / tension - 1.0) < 1e-15);
    BOOST_TEST(table.rows[k].at("index") == "0");
    // Tails of 12 and more: the closed form is exact far below the tolerance of 1e-8 the scene asks for.
    const double force = std::stod(table.rows[k].at("R_tot"));
    BOOST_TEST(std::abs(force / capstan::total_force(tension, angle) - 1.0) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(states_that_a_cylinder_drags_have_their_index) {
  // At 4 pi, T = 0.4, the flat coil, which is found first, is unstable: the row is of the stable state, as the answer of `solve`.
  const TemporaryFolder folder;
  const Words words{"sweep",  scene("capstan-2pi-plate.toml"),
                    "--over", "load.angle=2 pi,4 pi",
                    "--over", "load.tension=0.4,2",
                    "--out",  "out",
                    "--quiet"};
  const Outcome outcome = run_program(words, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const Table table = read_csv(folder.path() / "out" / "sweep.csv");
  BOOST_REQUIRE(table.rows.size() == 4u);
  for (const auto& row : table.rows) BOOST_TEST(row.at("index") == "0");
}

BOOST_AUTO_TEST_CASE(two_ranks_give_the_same_bytes_as_one) {
  if (!have_mpirun()) {
    BOOST_TEST_MESSAGE("mpirun is not installed: skipped");
    return;
  }
  const TemporaryFolder folder;
  for (const auto& sweep : {states, diagrams}) {
    for (const auto& [out, before] : {std::pair{"one", ""}, std::pair{"two", two_ranks}}) {
      const Outcome outcome = run_program(sweep(out, {"--force"}), folder.path(), before);
      BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    }
    for (const char* file : {"sweep.csv", "branches.csv"})
      BOOST_TEST(slurp(folder.path() / "two" / file) == slurp(folder.path() / "one" / file));
  }
  BOOST_TEST(slurp(folder.path() / "one" / "branches.csv").size() > 1000u);
}

BOOST_AUTO_TEST_CASE(a_killed_sweep_goes_on_to_what_it_would_have_become) {
  const TemporaryFolder folder;
  BOOST_REQUIRE(run_program(diagrams("whole"), folder.path()).status == 0);
  // In the midst of the second case.
  const fs::path second = folder.path() / "run" / "cases" / "000002" / "branches.csv";
  const Outcome killed = interrupt_program(diagrams("run"), folder.path(), SIGKILL, [&] {
    std::error_code missing;
    return fs::exists(second, missing) && fs::file_size(second, missing) > 2000;
  });
  BOOST_TEST(killed.status == 128 + SIGKILL);
  BOOST_TEST(!fs::exists(folder.path() / "run" / "sweep.csv"));
  const fs::path first = folder.path() / "run" / "cases" / "000001.csv";
  BOOST_REQUIRE(fs::exists(first));
  const auto written = fs::last_write_time(first);
  BOOST_TEST(run_program(diagrams("run", {"--resume"}), folder.path()).status == 0);
  BOOST_TEST((fs::last_write_time(first) == written));  // not computed again
  for (const char* file : {"sweep.csv", "branches.csv"})
    BOOST_TEST(slurp(folder.path() / "run" / file) == slurp(folder.path() / "whole" / file));
}

BOOST_AUTO_TEST_CASE(ctrl_c_keeps_what_is_finished) {
  const TemporaryFolder folder;
  const fs::path first = folder.path() / "run" / "cases" / "000001.csv";
  const Outcome stopped =
      interrupt_program(diagrams("run"), folder.path(), SIGINT, [&] { return fs::exists(first); });
  BOOST_TEST(stopped.status == 130);
  BOOST_TEST(read_csv(folder.path() / "run" / "sweep.csv").rows.size() < 3u);
  BOOST_TEST(run_program(diagrams("run", {"--resume"}), folder.path()).status == 0);
  BOOST_TEST(read_csv(folder.path() / "run" / "sweep.csv").rows.size() == 3u);
}

BOOST_AUTO_TEST_CASE(a_case_without_solution_is_a_row_that_says_why) {
  const TemporaryFolder folder;
  // At phi = 20 pi the contact arc alone is longer than the rod of 30.
  const Outcome outcome = run_program({"sweep", scene("capstan-2pi.toml"), "--set", "model.kind=planar",
                                       "--over", "load.angle=2 pi,20 pi", "--out", "out", "--quiet"},
                                      folder.path());
  BOOST_TEST(outcome.status == 2);
  const Table table = read_csv(folder.path() / "out" / "sweep.csv");
  BOOST_REQUIRE(table.rows.size() == 2u);
  BOOST_TEST(table.rows[0].at("failure").empty());
  BOOST_TEST(table.rows[1].at("failure").find("shorter than its contact arc") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_sweep_is_neither_overwritten_nor_mixed_with_another) {
  const TemporaryFolder folder;
  BOOST_REQUIRE(run_program(states("out"), folder.path()).status == 0);
  BOOST_TEST(run_program(states("out"), folder.path()).status == 1);
  BOOST_TEST(run_program(states("out", {"--resume", "--set", "rod.length=40"}), folder.path()).status == 1);
  BOOST_TEST(run_program(states("out", {"--force", "--set", "rod.length=40"}), folder.path()).status == 0);
}

BOOST_AUTO_TEST_CASE(bad_axes_are_answered) {
  for (const auto& [over, part] : {std::pair<std::string, std::string>{"load.tensoin=1:2:3", "load.tension"},
                                   {"load.tension=1:2", "KEY=FROM:TO:COUNT"},
                                   {"load.tension=1:2:0.5", "whole number"},
                                   {"load.tension=0:2:3:log", "above 0"},
                                   {"load.tension=1:x:3", "\"x\" is not a number"},
                                   {"load.angle=1 pi:180 deg:3", "different units"},
                                   {"load.tension=-1:2:3", "must be > 0"},
                                   {"model.kind=planar,kirchhoff", "is no number"},
                                   {"load.tension", "'='"}}) {
    const TemporaryFolder folder;
    const Outcome outcome = run_program({"sweep", scene("capstan-2pi.toml"), "--over", over}, folder.path());
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST_CONTEXT(over << ": " << outcome.err) {
      BOOST_TEST(outcome.err.find(part) != std::string::npos);
    }
    BOOST_TEST(fs::is_empty(folder.path()));
  }
}

BOOST_AUTO_TEST_SUITE_END()
