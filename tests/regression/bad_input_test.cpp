// What a user meets who makes a mistake: one line that says what is wrong, exit status 1, nothing on stdout.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

const std::string capstan = R"([rod]
length = 30
[cylinder]
[load]
tension = 1.0
angle = "2 pi"
[continuation]
from = 5.0
to = 0.1
)";

/// Runs `solve` on the capstan with `what` replaced by `by` and expects the message in a single line.
void expect_refusal(const std::string& what, const std::string& by, const std::string& message) {
  const TemporaryFolder folder;
  std::string text = capstan;
  const auto at = text.find(what);
  BOOST_REQUIRE(at != std::string::npos);
  folder.write("capstan.toml", text.replace(at, what.size(), by));
  const Outcome outcome = run_program({"solve", "capstan.toml", "--json"}, folder.path());
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(outcome.out == "");
  BOOST_TEST(outcome.err == "windlass: " + message + "\n");
  BOOST_TEST(!std::filesystem::exists(folder.path() / "runs"));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(bad_input)

BOOST_AUTO_TEST_CASE(values_out_of_range) {
  expect_refusal("tension = 1.0", "tension = 0", "capstan.toml:5: load.tension = 0: must be > 0");
  expect_refusal("tension = 1.0", "tension = -1", "capstan.toml:5: load.tension = -1: must be > 0");
  expect_refusal("\"2 pi\"", "0", "capstan.toml:6: load.angle = 0: must be > 0");
  expect_refusal("\"2 pi\"", "\"-pi\"", "capstan.toml:6: load.angle = \"-pi\": must be > 0");
  expect_refusal("length = 30", "length = 30\nradius = -0.1",
                 "capstan.toml:3: rod.radius = -0.1: must be >= 0");
}

BOOST_AUTO_TEST_CASE(an_option_that_cannot_be_is_named_once) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"plot", "run", "--format", "bmp"}, folder.path());
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(outcome.err.starts_with("--format: bmp: must be one of png, png@DOTS, svg, pdf\n"));
}

BOOST_AUTO_TEST_CASE(unknown_key) {
  expect_refusal("tension = 1.0", "tensoin = 1.0",
                 "capstan.toml:5: load.tensoin = 1: unknown key; did you mean load.tension?");
}

BOOST_AUTO_TEST_CASE(wrong_unit) {
  expect_refusal("length = 30", "length = \"30 N\"",
                 "capstan.toml:2: rod.length = \"30 N\": must be a length such as "
                 "\"4 mm\"");
  expect_refusal(
      "length = 30", "length = \"30 mn\"\nradius = \"1 banana\"",
      "capstan.toml:2: rod.length = \"30 mn\": \"mn\" is not a known unit; must be a length such as "
      "\"4 mm\"");
}

BOOST_AUTO_TEST_CASE(dimensionless_and_physical_mixed) {
  expect_refusal("tension = 1.0", "tension = \"2 N\"",
                 "capstan.toml:5: load.tension = \"2 N\": must be a number without a unit, like the other "
                 "quantities of this "
                 "scene");
}

BOOST_AUTO_TEST_CASE(truncated_toml) {
  const TemporaryFolder folder;
  folder.write("capstan.toml", capstan.substr(0, capstan.find(" pi")));
  const Outcome outcome = run_program({"diagram", "capstan.toml"}, folder.path());
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(contains(outcome.err, "windlass: capstan.toml:6: is not valid TOML: "), outcome.err);
}

BOOST_AUTO_TEST_CASE(unreadable_files) {
  const TemporaryFolder folder;
  const Outcome missing = run_program({"solve", "nothing.toml"}, folder.path());
  BOOST_TEST(missing.status == 1);
  BOOST_TEST(missing.err == "windlass: nothing.toml: cannot be read: No such file or directory\n");
  std::filesystem::create_directory(folder.path() / "folder");
  const Outcome directory = run_program({"solve", "folder"}, folder.path());
  BOOST_TEST(directory.status == 1);
  BOOST_TEST(directory.err == "windlass: folder: is a directory; a scene file was expected\n");
}

BOOST_AUTO_TEST_CASE(overrides) {
  const TemporaryFolder folder;
  folder.write("capstan.toml", capstan);
  const auto refused = [&](const std::vector<std::string>& words) {
    std::vector<std::string> arguments = {"solve", "capstan.toml"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Outcome outcome = run_program(arguments, folder.path());
    BOOST_TEST(outcome.status == 1);
    return outcome.err;
  };
  BOOST_TEST(refused({"--set", "load.angle=1", "--set", "load.tension=-2"}) ==
             "windlass: --set load.tension = -2: must be > 0\n");
  BOOST_TEST(refused({"--set", "lod.tension=2"}) ==
             "windlass: --set lod.tension = 2: unknown key; did you mean load.tension?\n");
  BOOST_TEST(refused({"--set", "tension"}) ==
             "windlass: --set tension: must have the form KEY=VALUE, such as load.tension=2\n");
}

BOOST_AUTO_TEST_CASE(run_folders_that_are_none) {
  const TemporaryFolder folder;
  for (const char* command : {"verify", "stability", "plot", "report"}) {
    const Outcome missing = run_program({command, "runs/none"}, folder.path());
    BOOST_TEST(missing.status == 1, command);
    BOOST_TEST(missing.err == "windlass: runs/none: no such run folder\n");
    const Outcome foreign = run_program({command, "."}, folder.path());
    BOOST_TEST(foreign.status == 1, command);
    BOOST_TEST(foreign.err == "windlass: .: is not a run folder: it has no scene.toml\n");
  }
}

BOOST_AUTO_TEST_CASE(command_lines) {
  const Outcome none = run_program({});
  BOOST_TEST(none.status == 1);
  BOOST_TEST(contains(none.err, "Usage: windlass"));
  const Outcome unknown = run_program({"sovle", "x.toml"});
  BOOST_TEST(unknown.status == 1);
  BOOST_TEST(contains(unknown.err, "windlass: sovle: no such command; must be one of solve, "), unknown.err);
  const Outcome option = run_program({"solve", "x.toml", "--frobnicate"});
  BOOST_TEST(option.status == 1);
  BOOST_TEST(contains(option.err, "--frobnicate"), option.err);
  const Outcome both = run_program({"diagram", "x.toml", "--force", "--resume"});
  BOOST_TEST(both.status == 1);
  BOOST_TEST(contains(both.err, "--force excludes --resume"), both.err);
}

BOOST_AUTO_TEST_SUITE_END()
