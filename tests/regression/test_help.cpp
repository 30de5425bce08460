// The program explains itself, and lists what it comes with, without starting MPI.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

using namespace windlass::test;

BOOST_AUTO_TEST_SUITE(help)

BOOST_AUTO_TEST_CASE(every_command_has_a_help_text) {
  for (const char* command :
       {"solve", "continue", "diagram", "locus", "stability", "verify", "plot", "report", "scenes"}) {
    const Outcome outcome = run_program({command, "--help"});
    BOOST_TEST(outcome.status == 0, command);
    BOOST_TEST(outcome.err == "");
    BOOST_TEST(outcome.out.find(std::string("Usage: windlass ") + command) != std::string::npos, outcome.out);
  }
  BOOST_TEST(run_program({"--help"}).status == 0);
  BOOST_TEST(run_program({"--version"}).out.find("windlass ") == 0u);
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
