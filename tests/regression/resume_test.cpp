// A run killed at any moment is readable and goes on to what it would have become.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "coil_run.hpp"
#include "support/interrupt_program.hpp"

using namespace windlass::test;
namespace fs = std::filesystem;

namespace {

/// Flat and helical branch of the 2π coil with their branch point and contact events, in some 60 points.
Words diagram(const Words& more = {}) {
  const std::string scene = shipped_scene("capstan-2pi");
  return Words{"diagram", scene, "--set", "continuation.to=0.4", "--quiet"} + more;
}

/// The uninterrupted run in `folder`/whole.
void make_whole(const TemporaryFolder& folder) {
  const Outcome outcome = run_program(diagram({"--out", "whole"}), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
}

/// All that a run says about its branches must be the same to the last digit: the walk is deterministic.
void expect_equal(const TemporaryFolder& folder) {
  for (const char* file : {"branches.csv", "special_points.json"})
    BOOST_TEST(slurp(folder.path() / "run" / file) == slurp(folder.path() / "whole" / file));
  const auto info = nlohmann::json::parse(slurp(folder.path() / "run" / "run.json"));
  const auto whole = nlohmann::json::parse(slurp(folder.path() / "whole" / "run.json"));
  BOOST_TEST(info["status"] == "finished");
  BOOST_TEST(info["summary"] == whole["summary"]);
  BOOST_TEST(!fs::exists(folder.path() / "run" / "checkpoint.cbor"));
}

std::uintmax_t size_of(const fs::path& path) {
  std::error_code missing;
  const std::uintmax_t size = fs::file_size(path, missing);
  return missing ? 0 : size;
}

/// Sends the signal once branches.csv of `folder`/run has grown to so many bytes: a moment that does not depend on how
/// busy the machine is.
Outcome interrupted(const Words& words, const TemporaryFolder& folder, int signal, std::uintmax_t bytes) {
  return interrupt_program(words, folder.path(), signal,
                           [&] { return size_of(folder.path() / "run" / "branches.csv") >= bytes; });
}

}  // namespace

BOOST_AUTO_TEST_SUITE(resume)

BOOST_AUTO_TEST_CASE(killed_at_random_moments) {
  const TemporaryFolder folder;
  make_whole(folder);
  const std::uintmax_t whole = size_of(folder.path() / "whole" / "branches.csv");
  const Words run = diagram({"--resume", "--save-every", "0", "--out", "run"});
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> share(0.0, 0.3);
  int kills = 0, with_points = 0;
  for (int k = 0; k < 20; ++k) {
    // A good part of a run further each time, so that several kills fall into one run.
    const auto further = static_cast<std::uintmax_t>(share(random) * static_cast<double>(whole));
    const std::uintmax_t goal = size_of(folder.path() / "run" / "branches.csv") + further;
    const Outcome outcome = interrupted(run, folder, SIGKILL, goal);
    const bool killed = outcome.status == 128 + SIGKILL;
    BOOST_REQUIRE_MESSAGE(killed || outcome.status == 0, outcome.err);
    kills += killed;
    if (fs::exists(folder.path() / "run")) {
      // Exit status 1 only where there is no point yet; what is stored passes.
      const Outcome certificate = run_program({"verify", "run"}, folder.path());
      const bool empty = certificate.status == 1 && contains(certificate.err, "holds no points");
      BOOST_REQUIRE_MESSAGE(empty || certificate.status == 0, certificate.out + certificate.err);
      with_points += !empty;
    }
    if (killed) continue;
    expect_equal(folder);
    fs::remove_all(folder.path() / "run");
  }
  BOOST_TEST(kills >= 15);
  BOOST_TEST(with_points >= 10);
  const Outcome rest = run_program(run, folder.path());
  BOOST_REQUIRE_MESSAGE(rest.status == 0, rest.err);
  expect_equal(folder);
  BOOST_TEST(run_program({"verify", "run"}, folder.path()).status == 0);
}

BOOST_AUTO_TEST_CASE(stopped_by_the_user) {
  const TemporaryFolder folder;
  make_whole(folder);
  const Words run = diagram({"--out", "run"});
  Outcome outcome = interrupted(run, folder, SIGINT, size_of(folder.path() / "whole" / "branches.csv") / 3);
  BOOST_REQUIRE_MESSAGE(outcome.status == 130, outcome.err);
  const auto info = nlohmann::json::parse(slurp(folder.path() / "run" / "run.json"));
  BOOST_TEST(info["status"] == "interrupted");
  outcome = run_program(run + Words{"--resume"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  expect_equal(folder);
  BOOST_TEST(nlohmann::json::parse(slurp(folder.path() / "run" / "run.json"))["timings"]["points"] >
             info["timings"]["points"]);

  // Once it is finished there is nothing left to do.
  const auto written = fs::last_write_time(folder.path() / "run" / "branches.csv");
  const std::string scene = run[1];
  const Outcome again = run_program(
      {"diagram", scene, "--set", "continuation.to=0.4", "--out", "run", "--resume"}, folder.path());
  BOOST_TEST(again.status == 0, again.err);
  BOOST_TEST(again.out == "run is finished: nothing to resume\n");
  BOOST_TEST((fs::last_write_time(folder.path() / "run" / "branches.csv") == written));
}

BOOST_AUTO_TEST_CASE(only_the_same_run_goes_on) {
  const TemporaryFolder folder;
  const Words run = diagram({"--save-every", "0", "--out", "run"});
  constexpr std::uintmax_t some_rows = 4000;
  BOOST_REQUIRE(interrupted(run, folder, SIGKILL, some_rows).status == 128 + SIGKILL);
  const std::string rows = slurp(folder.path() / "run" / "branches.csv");
  const auto refused = [&](const Words& words, const std::string& why) {
    const Outcome outcome = run_program(words, folder.path());
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST(contains(outcome.err, why), outcome.err);
    BOOST_TEST(slurp(folder.path() / "run" / "branches.csv") == rows);
  };
  const Words again = run + Words{"--resume"};
  refused(again + Words{"--set", "rod.length=31"}, "windlass: --resume: run holds another run: in the scene");
  refused(again + Words{"--no-eigenvalues"}, "it has the options");
  Words other = again;
  other[0] = "continue";
  refused(other, "it was made by `diagram`, not by `continue`");
  refused(run, "exists and is not empty; use --force");

  // Damage is named, not computed over.
  for (const char* file : {"checkpoint.cbor", "points.h5", "run.json"}) {
    const fs::path path = folder.path() / "run" / file;
    const std::string whole = slurp(path);
    fs::resize_file(path, fs::file_size(path) / 2);
    refused(again, std::string("windlass: cannot read run/") + file + ": it is truncated");
    std::ofstream(path, std::ios::binary) << whole;
  }
  BOOST_TEST(run_program(again, folder.path()).status == 0);
}

BOOST_AUTO_TEST_SUITE_END()
