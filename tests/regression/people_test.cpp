// What people do: full disks, two terminals, damaged folders, misspelt options, limits that are reached.
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>

#include "regression/coil_run.hpp"
#include "support/csv.hpp"
#include "support/interrupt_program.hpp"

using namespace windlass::test;
namespace fs = std::filesystem;

namespace {

const std::string strut = "[rod]\nlength = 1.0\n[load]\nthrust = 3.0\n[ends]\nkind = \"clamped\"\n";

std::size_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

/// How often `part` stands in `text`.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Runs the program with its standard output on a full disk.
Outcome on_a_full_disk(const std::string& words, const fs::path& folder) {
  const std::string command = "cd " + quoted(folder.string()) + " && " +
                              quoted(std::getenv("WINDLASS_BINARY")) + " " + words +
                              " > /dev/full 2> err < /dev/null";
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code), "", slurp(folder / "err")};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(people)

BOOST_AUTO_TEST_CASE(output_that_does_not_arrive) {
  const TemporaryFolder folder;
  folder.write("strut.toml", strut);
  for (const char* words :
       {"solve strut.toml --json", "solve strut.toml", "scenes --keys", "--help", "manual"}) {
    const Outcome outcome = on_a_full_disk(words, folder.path());
    BOOST_TEST(outcome.status == 2, words << ": " << outcome.status);
    BOOST_TEST(lines(outcome.err) == 1u, words << ": " << outcome.err);
    BOOST_TEST(contains(outcome.err, "No space left on device"), words << ": " << outcome.err);
  }
}

BOOST_AUTO_TEST_CASE(petsc_options_nobody_asked_for) {
  const TemporaryFolder folder;
  folder.write("strut.toml", strut);
  const Outcome misspelt =
      run_program({"solve", "strut.toml", "--json", "--", "-foo_bar", "3", "-snes_monitr"}, folder.path());
  BOOST_TEST(misspelt.status == 0);
  BOOST_TEST(contains(misspelt.err, "-foo_bar"), misspelt.err);
  BOOST_TEST(contains(misspelt.err, "-snes_monitr"), misspelt.err);
  const Outcome right =
      run_program({"solve", "strut.toml", "--json", "--", "-snes_max_it", "40"}, folder.path());
  BOOST_TEST(right.status == 0);
  BOOST_TEST(right.err == "");
}

BOOST_AUTO_TEST_CASE(petsc_options_act_on_every_solve_of_a_branch) {
  const TemporaryFolder folder;
  const std::vector<std::string> diagram = {
      "diagram", shipped_scene("capstan-2pi"), "--out", "run", "--force", "--set", "continuation.to=1"};
  const auto with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = diagram;
    words.push_back("--");
    words.insert(words.end(), options.begin(), options.end());
    return run_program(words, folder.path());
  };
  const Outcome watched = with({"-snes_monitor", "-snes_converged_reason"});
  BOOST_TEST_REQUIRE(watched.status == 0, watched.err);
  BOOST_TEST(!contains(watched.err, "-snes"), watched.err);  // nobody asked for it
  // A point was solved for at least once, and its last correction found at one state more than it took corrections.
  const Table table = read_csv(folder / "run/branches.csv");
  std::size_t corrections = 0;
  for (const auto& row : table.rows) corrections += std::stoul(row.at("newton_iterations"));
  BOOST_TEST_REQUIRE(table.rows.size() > 20u);
  BOOST_TEST(count(watched.out, "SNES Function norm") >= corrections + table.rows.size());
  BOOST_TEST(count(watched.out, "Nonlinear solve converged") >= table.rows.size());

  // One correction is too few for a step of the usual length: the walk takes many short ones, or gives up.
  const std::string usual = slurp(folder / "run/branches.csv");
  with({"-snes_max_it", "1"});
  BOOST_TEST(slurp(folder / "run/branches.csv") != usual);
}

BOOST_AUTO_TEST_CASE(what_was_not_reached_is_said) {
  const TemporaryFolder folder;
  folder.write("strut.toml", strut);
  const Outcome shortened =
      run_program({"continue", "strut.toml", "--out", "run", "--set", "continuation.parameter=load.thrust",
                   "--set", "continuation.to=100", "--set", "continuation.max_points=4"},
                  folder.path());
  BOOST_TEST(shortened.status == 2);
  BOOST_TEST(contains(shortened.out, "cut short: branch 1: max_points = 4 reached"), shortened.out);
  const auto info = nlohmann::json::parse(slurp(folder / "run/run.json"));
  BOOST_TEST(info["status"] == "incomplete");
  BOOST_TEST(info["summary"]["cut_short"].size() == 1u);
  BOOST_TEST(info["lost_branches"].empty());

  // Eight elements of order 12 cannot have the straight strut off by 1e-14; a bowed one carries rounding of that size.
  const Outcome precise = run_program(
      {"solve", "strut.toml", "--json", "--set", "load.thrust=60", "--set", "model.tolerance=1e-14"},
      folder.path());
  BOOST_REQUIRE(precise.status == 0);
  const auto answer = nlohmann::json::parse(precise.out);
  const bool met = answer["error_estimate"].get<double>() <= 1e-14;
  BOOST_TEST(answer["tolerance_met"].get<bool>() == met);
  BOOST_TEST(contains(precise.err, "model.tolerance = 1e-14 was not met") == !met, precise.err);
}

BOOST_AUTO_TEST_CASE(special_points_have_their_parameter) {
  const TemporaryFolder folder;
  folder.write("strut.toml", strut);
  const Outcome branch = run_program({"continue", "strut.toml", "--out", "run", "--quiet", "--set",
                                      "continuation.parameter=load.thrust", "--set", "continuation.to=50"},
                                     folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  BOOST_TEST(nlohmann::json::parse(slurp(folder / "run/run.json"))["parameter"] == "load.thrust");
  const auto special = nlohmann::json::parse(slurp(folder / "run/special_points.json"));
  BOOST_REQUIRE(special.size() == 1u);
  BOOST_TEST(special[0]["parameter"].get<double>() == 4.0 * M_PI * M_PI, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(special[0]["T"].is_null());  // a strut has none
}

BOOST_AUTO_TEST_CASE(a_restart_in_another_parameter) {
  const TemporaryFolder folder;
  make_run(folder);
  const Outcome outcome = run_program({"continue", "run", "1-3", "--out", "angle", "--quiet", "--set",
                                       "continuation.parameter=load.angle", "--set", "continuation.to=6.4"},
                                      folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto from = read_csv(folder / "run/branches.csv").rows.at(2),
             begin = read_csv(folder / "angle/branches.csv").rows.front();
  BOOST_TEST(begin.at("phi") == from.at("phi"));
  BOOST_TEST(begin.at("T") == from.at("T"));
  BOOST_TEST(std::stod(read_csv(folder / "angle/branches.csv").rows.back().at("phi")) == 6.4);
  const Outcome without =
      run_program({"continue", "run", "1-3", "--out", "none", "--set", "continuation.parameter=load.angle"},
                  folder.path());
  BOOST_TEST(without.status == 1);
  BOOST_TEST(contains(without.err, "continuation.to: missing; the last value of load.angle"), without.err);
}

BOOST_AUTO_TEST_CASE(one_writer_a_folder) {
  const TemporaryFolder folder;
  std::string second;
  int status = -1;
  const Outcome first = interrupt_program(
      {"diagram", shipped_scene("capstan-4pi"), "--out", "run", "--quiet"}, folder.path(), SIGINT, [&] {
        if (!fs::exists(folder / "run/points.h5")) return false;
        const Outcome outcome =
            run_program({"diagram", shipped_scene("capstan-4pi"), "--out", "run", "--force"}, folder.path());
        second = outcome.err, status = outcome.status;
        return true;
      });
  BOOST_TEST(first.status == 130);
  BOOST_TEST(status == 1);
  BOOST_TEST(lines(second) == 1u);
  BOOST_TEST(contains(second, "is being written by another windlass"), second);
  // A killed writer leaves nothing that had to be cleared away.
  BOOST_TEST(run_program({"continue", shipped_scene("capstan-pi"), "--out", "run", "--force", "--quiet"},
                         folder.path())
                 .status == 0);
}

BOOST_AUTO_TEST_CASE(damaged_run_folders) {
  const TemporaryFolder folder;
  make_run(folder);
  const char* files[] = {"points.h5", "run.json", "branches.csv", "special_points.json", "scene.toml"};
  const char* commands[] = {"verify", "stability", "plot", "report"};
  std::mt19937 random(8);
  for (int k = 0; k < 40; ++k) {
    const fs::path path = folder / "run" / files[k % std::size(files)];
    const std::string right = slurp(path);
    std::string wrong = right;
    std::size_t at = random() % wrong.size();
    while (std::isspace(static_cast<unsigned char>(wrong[at]))) at = random() % wrong.size();
    wrong[at] ^= static_cast<char>(1 + random() % 127);
    std::ofstream(path, std::ios::binary) << wrong;
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = run_program({commands[k % std::size(commands)], "run"}, folder.path());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    BOOST_TEST(outcome.status == 1, path << ", byte " << at << ": " << outcome.status << " " << outcome.err);
    BOOST_TEST(contains(outcome.err, path.filename().string()), outcome.err);
    BOOST_TEST(lines(outcome.err) == 1u, outcome.err);
    BOOST_TEST(seconds.count() < 10.0);
    std::ofstream(path, std::ios::binary) << right;
  }
  BOOST_TEST(run_program({"verify", "run"}, folder.path()).status == 0);
}

BOOST_AUTO_TEST_CASE(commands_to_come) {
  for (const char* command : {"relax", "table"}) {
    const Outcome outcome = run_program({command, "x.toml"});
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST(outcome.err == std::string("windlass: ") + command + ": this command is not built yet\n");
  }
}

BOOST_AUTO_TEST_CASE(thick_rods_that_pass_through_themselves) {
  const TemporaryFolder folder;
  folder.write(
      "coil.toml",
      "[rod]\nlength = 30\nradius = 0.2857\n[cylinder]\n[load]\ntension = 5.0\nangle = \"2.5 pi\"\n");
  const Outcome coil =
      run_program({"solve", "coil.toml", "--json", "--set", "model.kind=planar"}, folder.path());
  BOOST_REQUIRE_MESSAGE(coil.status == 0, coil.err);
  const auto answer = nlohmann::json::parse(coil.out);
  BOOST_TEST(answer["self_distance"].get<double>() < 1e-9);  // a flat coil of more than a turn crosses itself
  BOOST_TEST(contains(coil.err, "passes through itself"), coil.err);
  const Outcome open =
      run_program({"solve", "coil.toml", "--json", "--set", "load.angle=pi/2"}, folder.path());
  BOOST_REQUIRE(open.status == 0);
  BOOST_TEST(nlohmann::json::parse(open.out)["self_distance"].is_null());
  BOOST_TEST(open.err == "");
}

BOOST_AUTO_TEST_SUITE_END()
