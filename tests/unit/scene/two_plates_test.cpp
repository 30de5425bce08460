// One plate, or two: how they are written, and what is refused.
#include <boost/test/unit_test.hpp>

#include "support/temporary_folder.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/reader.hpp"

namespace {

using namespace windlass::scene;
using windlass::test::TemporaryFolder;

const std::string capstan =
    "[rod]\nlength = 30\n[cylinder]\nfriction = 0.32\nsliding = \"up\"\n[load]\ntension = 1\nangle = \"2 "
    "pi\"\n";
const std::string above = "[[plate]]\nheight = 0.5\nouter_radius = 3\n", below = "[[plate]]\nheight = -1.5\n";

Scene read_plates(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return read_scene(folder.write("capstan.toml", text), overrides);
}

std::string refused_plates(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_plates(text, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

bool says(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (message.find(word) == std::string::npos) return BOOST_TEST_MESSAGE(message), false;
  return true;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(plates)

BOOST_AUTO_TEST_CASE(one_plate_is_written_either_way) {
  const Scene table = read_plates(capstan + "[plate]\nheight = 0.5\nouter_radius = 3\n"),
              array = read_plates(capstan + above);
  BOOST_REQUIRE(table.plate.has_value());
  BOOST_TEST((table.plate == array.plate));
  BOOST_TEST(!array.second_plate.has_value());
  BOOST_TEST(table.resolved_toml == array.resolved_toml);
}

BOOST_AUTO_TEST_CASE(the_second_is_on_the_other_side) {
  const Scene scene = read_plates(capstan + above + below);
  BOOST_REQUIRE(scene.second_plate.has_value());
  BOOST_TEST(scene.plate->height == 0.5);
  BOOST_TEST(scene.plate->outer_radius == 3.0);
  BOOST_TEST(scene.second_plate->height == -1.5);
  BOOST_TEST((scene.second_plate->side == PlateSide::below));
  BOOST_TEST(std::isinf(scene.second_plate->outer_radius));
  BOOST_TEST(scene.plates().size() == 2u);
  // The same as [plate] and [plate.2], and as written by --set; and what is written out reads back.
  const Scene dotted =
      read_plates(capstan + "[plate]\nheight = 0.5\nouter_radius = 3\n[plate.2]\nheight = -1.5\n");
  BOOST_TEST(dotted.resolved_toml == scene.resolved_toml);
  const Scene set = read_plates(capstan + above, {"plate.2.height=-1.5"});
  BOOST_TEST(set.resolved_toml == scene.resolved_toml);
  BOOST_TEST((read_plates(scene.resolved_toml) == scene));
}

BOOST_AUTO_TEST_CASE(its_height_is_a_parameter) {
  Scene scene = read_plates(capstan + above + below +
                            "[continuation]\nparameter = \"plate.2.height\"\nfrom = -2\nto = -0.5\n");
  BOOST_TEST(get_parameter(scene, "plate.2.height") == -1.5);
  set_parameter(scene, "plate.2.height", -1.0);
  BOOST_TEST(scene.second_plate->height == -1.0);
}

BOOST_AUTO_TEST_CASE(plates_with_units) {
  const std::string metal =
      "[rod]\nlength = \"300 mm\"\nradius = \"4 mm\"\nyoungs_modulus = \"1.2 MPa\"\nself_contact = false\n"
      "[cylinder]\nradius = \"10 mm\"\nfriction = 0.32\nsliding = \"up\"\nfriction_couple = false\n"
      "[load]\ntension = \"130 g\"\nangle = \"2 pi\"\n"
      "[[plate]]\nheight = \"46 mm\"\nouter_radius = \"24.4 mm\"\n[[plate]]\nheight = \"-46 mm\"\n";
  const Scene scene = read_plates(metal);
  BOOST_TEST(std::abs(scene.second_plate->height + 46.0 / 14.0) < 1e-14);
  BOOST_TEST(std::abs(scene.plate->outer_radius - 24.4 / 14.0) < 1e-14);
}

BOOST_AUTO_TEST_CASE(bad_plates_are_refused) {
  BOOST_TEST(
      says(refused_plates(capstan + above + below + below), {"capstan.toml:", "third plate", "twice"}));
  BOOST_TEST(says(refused_plates(capstan + above + "[[plate]]\nheight = 0.7\n"),
                  {"plate.2.height = 0.7", "must be < 0.5", "no room"}));
  BOOST_TEST(says(refused_plates(capstan + above + below + "side = \"above\"\n"),
                  {"plate.2.side = \"above\"", "must be \"below\""}));
  BOOST_TEST(
      says(refused_plates(capstan + above + "[[plate]]\nouter_radius = 2\n"), {"plate.2.height: missing"}));
  BOOST_TEST(says(refused_plates(capstan + above + below + "outer_radius = 0.5\n"),
                  {"plate.2.outer_radius = 0.5", "must be >= 1"}));
  BOOST_TEST(
      says(refused_plates(capstan + above + below + "hight = 0.5\n"), {"unknown key", "plate.2.height"}));
  BOOST_TEST(
      says(refused_plates(capstan, {"plate.2.height=-1"}), {"plate.2.height", "needs a first [plate]"}));
  // Of a cylinder that slides up the first one holds the rod back.
  BOOST_TEST(
      says(refused_plates(capstan + "[[plate]]\nheight = -1\nside = \"below\"\n[[plate]]\nheight = 1\n"),
           {"plate.side = \"below\"", "the first"}));
  const std::string branch = "[continuation]\nparameter = \"plate.2.height\"\nfrom = -2\nto = 0.6\n";
  BOOST_TEST(
      says(refused_plates(capstan + above + below + branch), {"continuation.to = 0.6", "must be < 0.5"}));
  // A branch says where it starts.
  BOOST_TEST(
      read_plates(capstan + above + "[continuation]\nparameter = \"plate.2.height\"\nfrom = -2\nto = 0\n")
          .second_plate->height == -2.0);
  BOOST_TEST(
      says(refused_plates(capstan + above + "[continuation]\nparameter = \"plate.2.height\"\nto = 0\n"),
           {"plate.2.height", "second"}));
  BOOST_TEST(says(refused_plates(capstan + above + below + "[ends]\nkind = \"clamped\"\n"),
                  {"ends.kind = \"clamped\"", "two plates"}));
}

BOOST_AUTO_TEST_SUITE_END()
