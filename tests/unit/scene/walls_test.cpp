// [[wall]] tables: read, resolved, and refused with place, value and what is allowed.
#include <boost/test/unit_test.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/reader.hpp"

using namespace windlass::scene;
using windlass::test::TemporaryFolder;

namespace {

const std::string clamped_strut = "[rod]\nlength = 1.0\n[ends]\nkind = \"clamped\"\nshortening = 0.1\n";
const std::string wall = "[[wall]]\nnormal = [0.0, 1.0, 0.0]\ndistance = 0.1\n";

Scene read(const std::string& text, const std::vector<std::string>& set = {}) {
  const TemporaryFolder folder;
  return read_scene(folder.write("strut.toml", text), set);
}

std::string refusal(const std::string& text, const std::vector<std::string>& set = {}) {
  try {
    read(text, set);
    return "accepted";
  } catch (const SceneError& error) {
    const std::string message = error.what();
    const auto name = message.find("strut.toml");
    return name == std::string::npos ? message : message.substr(name);
  }
}

bool holds(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scene_walls)

BOOST_AUTO_TEST_CASE(any_number_in_the_order_of_the_file) {
  const Scene scene = read(clamped_strut + wall + "[[wall]]\nnormal = [0, -2, 0]\ndistance = 0.2\n");
  BOOST_TEST_REQUIRE(scene.walls.size() == 2u);
  BOOST_TEST(scene.walls[0].distance == 0.1);
  BOOST_TEST(scene.walls[1].normal[1] == -2.0);
  BOOST_TEST(scene.half_turn());
  const Scene again = read(scene.resolved_toml);
  BOOST_CHECK(again == scene);
  BOOST_TEST(read(clamped_strut).walls.empty());
}

BOOST_AUTO_TEST_CASE(a_wall_that_the_half_turn_moves_asks_for_the_full_chain) {
  const std::string oblique = "[[wall]]\nnormal = [0.0, 1.0, 0.5]\ndistance = 0.1\n";
  BOOST_TEST(!read(clamped_strut + oblique).half_turn());
  BOOST_TEST(holds(refusal(clamped_strut + oblique, {"model.symmetry=half_turn"}),
                   "model.symmetry = half_turn: must not be"));
}

BOOST_AUTO_TEST_CASE(physical_distances_have_units) {
  const std::string physical =
      "[rod]\nlength = \"500 mm\"\nbending_stiffness = \"2 N m^2\"\n[load]\nthrust = \"3 "
      "N\"\n[[wall]]\nnormal = "
      "[0.0, 1.0, 0.0]\ndistance = ";
  BOOST_TEST(read(physical + "\"5 mm\"\n").walls[0].distance == 0.01, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(holds(refusal(physical + "0.1\n"), "strut.toml:8: wall.distance = 0.1: must be a length"));
  BOOST_TEST(holds(refusal(clamped_strut + "[[wall]]\nnormal = [0.0, 1.0, 0.0]\ndistance = \"5 mm\"\n"),
                   "must be a number without a unit"));
}

BOOST_AUTO_TEST_CASE(refusals) {
  const auto with = [](const std::string& normal, const std::string& distance) {
    return refusal(clamped_strut + "[[wall]]\nnormal = " + normal + "\ndistance = " + distance + "\n");
  };
  for (const char* normal :
       {"[0.0, 0.0, 0.0]", "[0.0, 1.0]", "1.0", "\"up\"", "[0.0, inf, 0.0]", "[\"a\", 1.0, 2.0]"})
    BOOST_TEST(holds(with(normal, "0.1"), "strut.toml:7: wall.normal = "), with(normal, "0.1"));
  for (const char* distance : {"\"far\"", "true", "[1.0]", "nan", "inf"})
    BOOST_TEST(holds(with("[0.0, 1.0, 0.0]", distance), "strut.toml:8: wall.distance = "),
               with("[0.0, 1.0, 0.0]", distance));
  // The straight strut reaches from x = −1/2 to 1/2.
  BOOST_TEST(holds(with("[0.0, 1.0, 0.0]", "0.0"), "must be > 0: the straight strut"));
  BOOST_TEST(holds(with("[0.0, 1.0, 0.0]", "-0.1"), "must be > 0: the straight strut"));
  BOOST_TEST(holds(with("[2.0, 0.0, 0.0]", "0.5"), "must be > 0.5: the straight strut"));
  BOOST_TEST(with("[2.0, 0.0, 0.0]", "0.51") == "accepted");
  BOOST_TEST(
      holds(refusal(clamped_strut + "[[wall]]\nnormal = [0.0, 1.0, 0.0]\n"), "wall.distance: missing"));
  BOOST_TEST(holds(refusal(clamped_strut + "[[wall]]\ndistance = 0.1\n"), "wall.normal: missing"));
  BOOST_TEST(holds(refusal(clamped_strut + wall + "friction = 0.1\n"), "wall.friction = 0.1: unknown key"));
  BOOST_TEST(holds(refusal(clamped_strut + "[wall]\nnormal = [0.0, 1.0, 0.0]\ndistance = 0.1\n"),
                   "a table [[wall]]"));
  BOOST_TEST(holds(refusal(clamped_strut + wall, {"wall.distance=0.2"}), "must be given in the scene file"));
  const std::string capstan = "[rod]\nlength = 30\n[cylinder]\n[load]\ntension = 1.0\nangle = 6.0\n";
  BOOST_TEST(holds(refusal(capstan + wall), "walls beside a [cylinder] are not built yet"));
}

BOOST_AUTO_TEST_SUITE_END()
