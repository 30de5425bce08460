// Every key is fed with what it cannot be: the message names that key, the value, and what is allowed.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/reader.hpp"

using namespace windlass::scene;
using windlass::test::TemporaryFolder;

namespace {

const std::string capstan =
    "[rod]\nlength = 30\n[cylinder]\n[load]\ntension = 1.0\nangle = \"2 pi\"\n[continuation]\nfrom = 5.0\nto "
    "= 0.1\n";
const std::string least_strut = "[rod]\nlength = 1.0\n[load]\nthrust = 3.0\n[ends]\ntwist = 0.0\n";
const std::string least_physical =
    "[rod]\nlength = \"300 mm\"\nradius = \"4 mm\"\nyoungs_modulus = \"1.2 MPa\"\n[cylinder]\nradius = \"10 "
    "mm\"\n"
    "[load]\ntension = \"500 g\"\nangle = \"pi\"\n[continuation]\nto = \"50 g\"\n";

/// The message a scene is refused with; empty where it is accepted.
std::string refusal(const TemporaryFolder& folder, const std::string& text, const std::string& set,
                    Scene* read = nullptr) {
  const std::string path = folder.write("scene.toml", text).string();
  try {
    const Scene scene = read_scene(path, std::vector<std::string>{set});
    if (read) *read = scene;
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

/// A message in one line that begins with the place and "KEY = VALUE: must".
void expect_named(const std::string& message, const std::string& key, const std::string& set) {
  BOOST_TEST(message.starts_with("--set " + key + " = "), set << ": " << message);
  BOOST_TEST((message.find(": must") != std::string::npos || message.find("; must") != std::string::npos ||
              message.find("belongs to a strut") != std::string::npos ||
              message.find("needs a [cylinder]") != std::string::npos),
             set << ": " << message);
  BOOST_TEST(message.find('\n') == std::string::npos, message);
  // Another key only as the reason, after a rule; never "did you mean" for a key that exists.
  BOOST_TEST(message.find("did you mean") == std::string::npos, set << ": " << message);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(refusals)

BOOST_AUTO_TEST_CASE(every_key_with_what_it_cannot_be) {
  const TemporaryFolder folder;
  for (const std::string& text : {capstan, least_strut, least_physical})
    for (const Key& key : keys()) {
      std::vector<std::string> never = {"[1, 2]", "1979-05-27"};
      never.push_back(key.kind == ValueKind::truth ? "1" : "true");
      if (key.kind == ValueKind::text) {
        never.push_back("3"), never.push_back("1.5");
        if (!key.choices.empty()) never.push_back("sideways");
      } else {
        for (const char* value :
             {"abc", "nan", "-inf", "1e300", "-1e300", "3 bananas", "\"\"", "1 kg m^2 s A"})
          never.push_back(value);
        if (!key.range.allows_infinity || key.kind == ValueKind::truth) never.push_back("inf");
        if (key.range.low == 0.0) never.push_back("-1");
        if (key.range.low == 0.0 && key.range.open_low) never.push_back("0");
      }
      for (const std::string& value : never) {
        const std::string set = std::string(key.name) + "=" + value;
        const std::string message = refusal(folder, text, set);
        BOOST_TEST(!message.empty(), set);
        if ((key.table() == "continuation" && text == strut) || key.table() == "scale")
          continue;  // on a scene without these tables others may be missing first
        BOOST_TEST_CONTEXT(text) expect_named(message, std::string(key.name), set);
      }
    }
}

BOOST_AUTO_TEST_CASE(quantities_of_the_wrong_kind) {
  const TemporaryFolder folder;
  for (const Key& key : keys()) {
    if (!is_dimensional(key.dimension)) continue;
    const std::string name(key.name);
    const std::string wrong = key.dimension == Dimension::length ? "2 N" : "2 mm";
    expect_named(refusal(folder, physical, name + "=" + wrong), name, name + "=" + wrong);
    // One quantity with a unit in a scene of plain numbers is the mistake, not the others.
    const std::string right = key.dimension == Dimension::length      ? "2 mm"
                              : key.dimension == Dimension::curvature ? "2 1/m"
                              : key.dimension == Dimension::force     ? "2 N"
                              : key.dimension == Dimension::stiffness ? "2 N m^2"
                                                                      : "2 MPa";
    expect_named(refusal(folder, capstan, name + "=" + right), name, name + "=" + right);
  }
  BOOST_TEST(refusal(folder, physical, "load.tension=2") ==
             "--set load.tension = 2: must be a force such as \"2 N\" or a hung mass such as \"500 g\", like "
             "the other "
             "quantities of this scene");
}

BOOST_AUTO_TEST_CASE(parameters_a_branch_cannot_be_followed_in) {
  const TemporaryFolder folder;
  for (const char* name : {"rod.radius", "model.tolerance", "title", "load.tensoin", ""}) {
    const std::string message = refusal(folder, capstan, std::string("continuation.parameter=") + name);
    if (*name) expect_named(message, "continuation.parameter", name);
    BOOST_TEST(message.find("\"load.tension\"") != std::string::npos, message);
  }
}

BOOST_AUTO_TEST_CASE(what_holds_anyway_may_be_said) {
  const TemporaryFolder folder;
  for (const char* set :
       {"rod.extensible=false", "rod.axial_stiffness=inf", "rod.self_contact=false", "cylinder.sliding=none",
        "cylinder.friction_couple=true", "ends.travel=free", "knot.kind=none"})
    BOOST_TEST(refusal(folder, capstan, set) == "", set);
}

BOOST_AUTO_TEST_CASE(rods_that_stretch_or_weigh_where_they_cannot) {
  const TemporaryFolder folder;
  const std::string stretches = std::string(capstan) + "\n";  // [rod] is the first table
  const auto both = [&](const char* first, const char* second) {
    const std::string path = folder.write("scene.toml", stretches).string();
    try {
      read_scene(path, std::vector<std::string>{first, second});
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // Neither the stiffness nor a radius that it follows from.
  BOOST_TEST(refusal(folder, capstan, "rod.extensible=true").find("rod.axial_stiffness: missing") !=
             std::string::npos);
  expect_named(refusal(folder, capstan, "rod.axial_stiffness=100"), "rod.axial_stiffness",
               "rod.axial_stiffness=100");
  expect_named(both("rod.extensible=true", "rod.axial_stiffness=0"), "rod.axial_stiffness",
               "rod.axial_stiffness=0");
  BOOST_TEST(both("rod.extensible=true", "rod.axial_stiffness=100") == "");
  BOOST_TEST(both("rod.extensible=true", "rod.axial_compliance=0.01") == "");
  BOOST_TEST(both("rod.extensible=true", "rod.radius=0.2") == "");
  BOOST_TEST(refusal(folder, capstan, "rod.weight=[0.0, -1.0]").find("three forces per length") !=
             std::string::npos);
  const std::string weighs = refusal(folder, capstan, "rod.weight=[0.0, -1.0, 0.0]");
  BOOST_TEST(weighs.find("rod.weight_y = -1: must be 0 with [cylinder]") != std::string::npos, weighs);
  BOOST_TEST(refusal(folder, capstan, "rod.weight=[0.0, 0.0, 0.0]") == "");
}

BOOST_AUTO_TEST_CASE(another_parameter_takes_no_values_of_the_old_one) {
  const TemporaryFolder folder;
  const std::string path = folder.write("scene.toml", capstan).string();
  const std::vector<std::string> set = {"continuation.parameter=load.angle", "continuation.to=7"};
  const Scene scene = read_scene(path, set);
  BOOST_TEST(scene.continuation->from == scene.load.angle);
  BOOST_TEST(scene.continuation->to == 7.0);
  BOOST_TEST(refusal(folder, capstan, "continuation.parameter=load.angle").find("continuation.to: missing") !=
             std::string::npos);
  BOOST_TEST(refusal(folder, capstan, "continuation.parameter=load.tension") == "");
  // A stored point says itself where a branch begins.
  BOOST_CHECK_THROW(read_scene(path, std::vector<std::string>{"continuation.to=5"}), SceneError);
  BOOST_TEST(
      read_scene(path, std::vector<std::string>{"continuation.to=5"}, {.restart = true}).continuation->to ==
      5.0);
}

BOOST_AUTO_TEST_SUITE_END()
