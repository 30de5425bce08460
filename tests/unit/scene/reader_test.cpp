#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "support/temporary_folder.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/reader.hpp"

using namespace windlass::scene;
using std::numbers::pi;
using windlass::test::TemporaryFolder;
namespace tt = boost::test_tools;

namespace {

const std::string dimensionless = R"(title = "a capstan"
[rod]
length = 30
[cylinder]
friction = 0.32
[load]
tension = 1.0
angle = "2 pi"
[continuation]
from = 5.0
to = 0.1
)";

const std::string physical = R"([rod]
length = "300 mm"
radius = "4 mm"
youngs_modulus = "1.2 MPa"
poisson_ratio = 0.25
natural_curvature = "10 1/m"
[cylinder]
radius = "10 mm"
[load]
tension = "500 g"
angle = "pi"
[continuation]
to = "50 g"
)";

const std::string strut =
    "[rod]\nlength = \"0.5 m\"\nbending_stiffness = \"2 N m^2\"\n[load]\nthrust = \"3 N\"\n";

Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return read_scene(folder.write("capstan.toml", text), overrides);
}

/// The message a scene is refused with, without the folder in front.
std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const SceneError& error) {
    const std::string message = error.what();
    const auto name = message.find("capstan.toml");
    return name == std::string::npos ? message : message.substr(name);
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  BOOST_REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scene_reader)

BOOST_AUTO_TEST_CASE(a_dimensionless_scene_with_defaults) {
  const Scene scene = read(dimensionless);
  BOOST_TEST(scene.name == "capstan");
  BOOST_TEST(scene.title == "a capstan");
  BOOST_TEST(scene.rod.length == 30.0);
  BOOST_TEST(scene.rod.twist_ratio == 2.0 / 3.0);
  BOOST_TEST(scene.has_cylinder);
  BOOST_TEST(scene.friction.value() == 0.32);
  BOOST_TEST(scene.load.tension == 1.0);
  BOOST_TEST(scene.load.angle == 2 * pi);
  BOOST_CHECK(scene.ends.kind == EndKind::moment_free);
  BOOST_CHECK(scene.model.kind == ModelKind::automatic);
  BOOST_TEST(scene.continuation.value().parameter == "load.tension");
  BOOST_TEST(scene.continuation->from == 5.0);
  BOOST_TEST(!scene.units.has_value());
}

BOOST_AUTO_TEST_CASE(a_physical_scene_becomes_dimensionless) {
  const Scene scene = read(physical);
  const double rho = 0.014, stiffness = 1.2e6 * pi * std::pow(0.004, 4) / 4.0;
  BOOST_TEST(scene.units.value().length == rho, tt::tolerance(1e-14));
  BOOST_TEST(scene.units->bending_stiffness == stiffness, tt::tolerance(1e-14));
  BOOST_TEST(scene.rod.length == 0.3 / rho, tt::tolerance(1e-14));
  BOOST_TEST(scene.rod_radius == 4.0 / 14.0, tt::tolerance(1e-14));
  BOOST_TEST(scene.rod.bending_stiffness == 1.0);
  BOOST_TEST(scene.rod.bending_stiffness_2 == 1.0);
  BOOST_TEST(scene.rod.twist_ratio == 0.8, tt::tolerance(1e-14));
  BOOST_TEST(scene.rod.natural_curvature == 10.0 * rho, tt::tolerance(1e-14));
  BOOST_TEST(scene.load.tension == 0.5 * 9.80665 * rho * rho / stiffness, tt::tolerance(1e-14));
  BOOST_TEST(scene.load.angle == pi);
  BOOST_TEST(scene.continuation.value().from == scene.load.tension);
  BOOST_TEST(scene.continuation->to == 0.1 * scene.load.tension, tt::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(a_physical_strut_has_the_length_as_unit) {
  const Scene scene = read(strut);
  BOOST_TEST(!scene.has_cylinder);
  BOOST_TEST(scene.rod.length == 1.0);
  BOOST_TEST(scene.units.value().length == 0.5);
  BOOST_TEST(scene.load.thrust.value() == 3.0 * 0.25 / 2.0, tt::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(the_resolved_scene_reads_back_equal) {
  const std::string infinite = replaced(dimensionless, "length = 30", "length = \"inf\"");
  const std::string quoted = replaced(dimensionless, "a capstan", "a \\\"quoted\\\" \\t title, ρ = 1");
  for (const std::string& text : {dimensionless, physical, strut, infinite, quoted}) {
    const Scene scene = read(text, {"model.tolerance=1e-9", "rod.natural_twist=0"});
    const Scene again = read(scene.resolved_toml);
    BOOST_CHECK(again == scene);
    BOOST_TEST(again.resolved_toml == scene.resolved_toml);
  }
}

BOOST_AUTO_TEST_CASE(a_resolved_scene_takes_overrides_in_both_ways) {
  const Scene scene = read(physical);
  BOOST_TEST(read(scene.resolved_toml, {"load.tension=2"}).load.tension == 2.0);
  BOOST_TEST(read(scene.resolved_toml, {"load.tension=250 g"}).load.tension == scene.load.tension / 2,
             tt::tolerance(1e-14));
  BOOST_TEST(refusal(scene.resolved_toml, {"rod.youngs_modulus=2 MPa"}) ==
             "--set rod.youngs_modulus = 2 MPa: must not be given beside [scale], which contains it already");
}

BOOST_AUTO_TEST_CASE(overrides_replace_and_add) {
  const Scene scene = read(dimensionless, {"load.tension=2", "load.angle=pi/2", "rod.length=inf",
                                           "ends.kind=clamped", "title=other words", "load.tension = 3"});
  BOOST_TEST(scene.load.tension == 3.0);  // the last one counts
  BOOST_TEST(scene.load.angle == pi / 2);
  BOOST_TEST(scene.rod.infinite());
  BOOST_CHECK(scene.ends.kind == EndKind::clamped);
  BOOST_TEST(scene.title == "other words");
  for (const auto& [value, number] : {std::pair{".5", 0.5}, {"5.", 5.0}, {"5e-1", 0.5}})
    BOOST_TEST(read(dimensionless, {std::string("load.tension=") + value}).load.tension == number);
}

BOOST_AUTO_TEST_CASE(a_branch_says_where_the_scene_starts) {
  const Scene scene = read(replaced(dimensionless, "tension = 1.0", ""));
  BOOST_TEST(scene.load.tension == 5.0);
}

BOOST_AUTO_TEST_CASE(bad_values_name_place_key_value_and_remedy) {
  const auto with = [](const std::string& what, const std::string& by) {
    return refusal(replaced(dimensionless, what, by));
  };
  BOOST_TEST(with("tension = 1.0", "tension = -1") == "capstan.toml:7: load.tension = -1: must be > 0");
  BOOST_TEST(with("tension = 1.0", "tension = 0") == "capstan.toml:7: load.tension = 0: must be > 0");
  BOOST_TEST(with("tension = 1.0", "tension = nan") ==
             "capstan.toml:7: load.tension = nan: must be > 0 and finite");
  BOOST_TEST(with("tension = 1.0", "tension = inf") ==
             "capstan.toml:7: load.tension = inf: must be > 0 and finite");
  BOOST_TEST(with("\"2 pi\"", "0") == "capstan.toml:8: load.angle = 0: must be > 0");
  BOOST_TEST(
      with("\"2 pi\"", "\"two\"") ==
      "capstan.toml:8: load.angle = \"two\": must be an angle such as \"2 pi\", \"90 deg\" or a number in "
      "radians");
  BOOST_TEST(with("0.32", "-0.1") == "capstan.toml:5: cylinder.friction = -0.1: must be >= 0");
  BOOST_TEST(with("0.32", "\"much\"") ==
             "capstan.toml:5: cylinder.friction = \"much\": must be a number, >= 0");
  BOOST_TEST(with("length = 30", "length = true") ==
             "capstan.toml:3: rod.length = true: must be a length such as \"4 mm\", > 0 or \"inf\"");
  BOOST_TEST(with("length = 30", "length = [1, 2]").find("capstan.toml:3: rod.length = [ 1, 2 ]: must be") ==
             0u);
  BOOST_TEST(with("to = 0.1", "to = 0") == "capstan.toml:11: continuation.to = 0: must be > 0");
  BOOST_TEST(with("to = 0.1", "to = 0.1\nmax_points = 2.5") ==
             "capstan.toml:12: continuation.max_points = 2.5: must be a whole number >= 2 and <= 1000000");
}

BOOST_AUTO_TEST_CASE(bad_names_get_a_suggestion) {
  BOOST_TEST(refusal(replaced(dimensionless, "tension =", "tensoin =")) ==
             "capstan.toml:7: load.tensoin = 1: unknown key; did you mean load.tension?");
  BOOST_TEST(refusal(dimensionless + "[modell]\n") ==
             "capstan.toml:12: [modell]: unknown table; did you mean [model]?");
  BOOST_TEST(
      refusal(dimensionless + "parameter = \"load.tensio\"\n")
          .find(
              "capstan.toml:12: continuation.parameter = \"load.tensio\": must be a key that a branch can be "
              "followed in, one of \"rod.length\", ") == 0u);
  BOOST_TEST(refusal(dimensionless + "[ends]\nkind = \"free\"\n") ==
             "capstan.toml:13: ends.kind = \"free\": must be one of \"moment_free\", \"clamped\", "
             "\"pinned\", \"spin_held\"");
}

BOOST_AUTO_TEST_CASE(overrides_are_named_in_messages) {
  BOOST_TEST(refusal(dimensionless, {"load.tension=-1"}) == "--set load.tension = -1: must be > 0");
  BOOST_TEST(refusal(dimensionless, {"load.tenson=1"}) ==
             "--set load.tenson = 1: unknown key; did you mean load.tension?");
  BOOST_TEST(refusal(dimensionless, {"load.tension"}) ==
             "--set load.tension: must have the form KEY=VALUE, such as load.tension=2");
  BOOST_TEST(
      refusal(dimensionless, {"ends.kind=free"}) ==
      "--set ends.kind = free: must be one of \"moment_free\", \"clamped\", \"pinned\", \"spin_held\"");
}

BOOST_AUTO_TEST_CASE(wholly_dimensionless_or_wholly_physical) {
  BOOST_TEST(
      refusal(replaced(physical, "\"300 mm\"", "30")) ==
      "capstan.toml:2: rod.length = 30: must be a length such as \"4 mm\", like the other quantities of "
      "this scene");
  BOOST_TEST(
      refusal(dimensionless, {"load.tension=2 N"}) ==
      "--set load.tension = 2 N: must be a number without a unit, like the other quantities of this scene");
  BOOST_TEST(refusal(physical, {"load.tension=2"}).find("--set load.tension = 2: must be a force such as") ==
             0u);
  BOOST_TEST(refusal(replaced(physical, "\"4 mm\"", "\"4 N\"")) ==
             "capstan.toml:3: rod.radius = \"4 N\": must be a length such as \"4 mm\"");
  BOOST_TEST(refusal(replaced(physical, "\"4 mm\"", "\"-4 mm\"")) ==
             "capstan.toml:3: rod.radius = \"-4 mm\": must be >= 0");
  BOOST_TEST(refusal(dimensionless, {"rod.youngs_modulus=1"}).find("must be a pressure such as") !=
             std::string::npos);
  BOOST_TEST(refusal(physical, {"rod.bending_stiffness=1 N m^2"}).find("must not be given beside") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(keys_that_belong_together) {
  BOOST_TEST(refusal("[cylinder]\n[load]\ntension = 1\nangle = 1\n") ==
             "capstan.toml: rod.length: missing; must be > 0 or \"inf\"");
  BOOST_TEST(refusal("[rod]\nlength = 30\n[cylinder]\n[load]\ntension = 1\n") ==
             "capstan.toml:4: load.angle: missing; must be > 0 with [cylinder]");
  BOOST_TEST(
      refusal("[rod]\nlength = 1\n[load]\ntension = 1\n") ==
      "capstan.toml:4: load.tension = 1: needs a [cylinder]; a strut has load.thrust or ends.shortening");
  BOOST_TEST(refusal("[rod]\nlength = 1\n").find("ends.shortening: missing") != std::string::npos);
  BOOST_TEST(refusal("[rod]\nlength = \"inf\"\n[load]\nthrust = 1\n").find("must be finite") !=
             std::string::npos);
  BOOST_TEST(refusal(dimensionless, {"ends.shortening=0.1"}).find("belongs to a strut") != std::string::npos);
  BOOST_TEST(refusal(dimensionless, {"continuation.to=5"}) ==
             "--set continuation.to = 5: must be finite and differ from continuation.from = 5");
  BOOST_TEST(refusal(dimensionless, {"cylinder.radius=2"}).find("must be 1 = 1 - rod.radius") !=
             std::string::npos);
  BOOST_TEST(refusal(dimensionless, {"name=../up"}).find("must be a file name") != std::string::npos);
  BOOST_CHECK_NO_THROW(read(dimensionless, {"cylinder.radius=0.75", "rod.radius=0.25"}));
}

BOOST_AUTO_TEST_CASE(files_that_are_no_scenes) {
  BOOST_TEST(refusal("[rod]\nlength = 30\n[load\n").find("capstan.toml:3: is not valid TOML: ") == 0u);
  BOOST_TEST(refusal("[rod]\nlength = \"30\n").find("capstan.toml:2: is not valid TOML: ") == 0u);
  BOOST_TEST(refusal("").find("capstan.toml: rod.length: missing") == 0u);
  BOOST_CHECK_EXCEPTION(read_scene("/no/such/scene.toml"), SceneError, [](const SceneError& error) {
    return std::string(error.what()) == "/no/such/scene.toml: cannot be read: No such file or directory";
  });
  const TemporaryFolder folder;
  BOOST_CHECK_EXCEPTION(read_scene(folder.path()), SceneError, [](const SceneError& error) {
    return std::string(error.what()).find("is a directory") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(every_shipped_scene_can_be_read) {
  const char* shipped = std::getenv("WINDLASS_SCENES");
  BOOST_REQUIRE(shipped);
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shipped)) {
    if (entry.path().extension() != ".toml") continue;
    const Scene scene = read_scene(entry.path());
    BOOST_TEST(!scene.title.empty(), entry.path());
    BOOST_TEST(scene.continuation.has_value(), entry.path());
    ++count;
  }
  BOOST_TEST(count >= 13);
}

BOOST_AUTO_TEST_SUITE_END()
