// The program explains itself, and lists what it comes with, without starting MPI.
#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

using namespace windlass::test;

BOOST_AUTO_TEST_SUITE(help)

BOOST_AUTO_TEST_CASE(every_command_has_a_help_text) {
  for (const char* command :
       {"solve", "continue", "diagram", "locus", "stability", "verify", "plot", "report", "fit", "figures",
        "export", "sweep", "pull", "robustness", "precision", "scenes", "manual", "completion"}) {
    const Outcome outcome = run_program({command, "--help"});
    BOOST_TEST(outcome.status == 0, command);
    BOOST_TEST(outcome.err == "");
    BOOST_TEST(outcome.out.find(std::string("Usage: windlass ") + command) != std::string::npos, outcome.out);
  }
  BOOST_TEST(run_program({"--help"}).status == 0);
  BOOST_TEST(run_program({"--version"}).out.find("windlass ") == 0u);
}

BOOST_AUTO_TEST_CASE(the_manual_names_every_command_option_and_key) {
  const Outcome outcome = run_program({"manual"});
  BOOST_REQUIRE(outcome.status == 0);
  BOOST_TEST(outcome.out.find(".TH WINDLASS 1") == 0u);
  for (const char* part :
       {"windlass diagram SCENE", "\\-\\-min\\-tension", "continuation.max_points", ".SH COMMON OPTIONS"})
    BOOST_TEST(outcome.out.find(part) != std::string::npos, part);
  BOOST_TEST(outcome.out.find("{false}") == std::string::npos);
  if (std::system("command -v groff > /dev/null 2>&1") != 0) return;
  const TemporaryFolder folder;
  folder.write("page.1", outcome.out);
  const std::string check =
      "cd " + quoted(folder.path().string()) + " && groff -man -ww -Tutf8 page.1 > text 2> warnings";
  BOOST_TEST(std::system(check.c_str()) == 0);
  BOOST_TEST(slurp(folder.path() / "warnings") == "");
}

BOOST_AUTO_TEST_CASE(bash_completes_commands_options_choices_and_labels) {
  const Outcome outcome = run_program({"completion"});
  BOOST_REQUIRE(outcome.status == 0);
  const TemporaryFolder folder;
  folder.write("completion", outcome.out);
  std::filesystem::create_directory(folder.path() / "run");
  folder.write("run/special_points.json", "[\n  {\n    \"label\": \"B1\",\n    \"type\": \"x\"}]");
  const auto completed = [&](const std::string& words, int at) {
    const std::string command =
        "cd " + quoted(folder.path().string()) + " && bash -c " +
        quoted("source ./completion; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
               "; _windlass; echo ${COMPREPLY[@]}") +
        " > out 2>&1";
    BOOST_TEST(std::system(command.c_str()) == 0);
    return slurp(folder.path() / "out");
  };
  BOOST_TEST(completed("windlass dia", 1) == "diagram\n");
  BOOST_TEST(completed("windlass plot run --form", 3) == "--format\n");
  BOOST_TEST(completed("windlass plot run --format s", 4) == "svg\n");
  BOOST_TEST(completed("windlass locus run \"\"", 3) == "B1\n");
  BOOST_TEST(completed("windlass locus --force --in load.angle run \"\"", 6) == "B1\n");
  BOOST_TEST(completed("windlass solve x.toml --set load.ten", 4) == "load.tension\n");
}

BOOST_AUTO_TEST_CASE(scenes_are_listed) {
  const Outcome outcome = run_program({"scenes", "--json"});
  BOOST_REQUIRE(outcome.status == 0);
  const auto list = nlohmann::json::parse(outcome.out);
  BOOST_TEST(list.size() >= 13u);
  bool first_scene = false;
  for (const auto& scene : list) {
    BOOST_TEST(std::filesystem::exists(scene["file"].get<std::string>()));
    BOOST_TEST(!scene["title"].get<std::string>().empty());
    first_scene = first_scene || scene["name"] == "capstan-vps-pom";
  }
  BOOST_TEST(first_scene);
}

BOOST_AUTO_TEST_CASE(keys_are_listed_with_their_ranges) {
  const Outcome outcome = run_program({"scenes", "--keys"});
  BOOST_REQUIRE(outcome.status == 0);
  for (const char* key : {"load.tension", "model.tolerance", "continuation.max_points", "ends.kind"})
    BOOST_TEST(outcome.out.find(key) != std::string::npos, key);
}

BOOST_AUTO_TEST_SUITE_END()
