#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

using namespace windlass::scene;

BOOST_AUTO_TEST_SUITE(scene_keys)

BOOST_AUTO_TEST_CASE(names_are_unique_and_explained) {
  std::set<std::string_view> names;
  for (const Key& key : keys()) {
    BOOST_TEST(names.insert(key.name).second, key.name << " stands twice");
    BOOST_TEST(!key.help.empty());
    BOOST_TEST((key.get == nullptr) == (key.set == nullptr));
    BOOST_TEST((key.get_text == nullptr) == (key.set_text == nullptr));
    BOOST_TEST(find_key(key.name) == &key);
  }
  BOOST_TEST(find_key("load.tensoin") == nullptr);
}

BOOST_AUTO_TEST_CASE(every_numeric_key_can_be_set_and_read) {
  int count = 0;
  for (const Key& key : keys()) {
    if (!is_numeric_key(key.name)) continue;
    Scene scene;
    scene.rod.extensible = key.name.starts_with("rod.axial_");  // what only a rod that stretches has
    if (key.name == "ends.guide_offset") scene.ends.guide = Guide::slider;
    const Scene before = scene;
    set_parameter(scene, key.name, 0.625);
    BOOST_TEST(get_parameter(scene, key.name) == 0.625, key.name);
    BOOST_TEST(!(scene == before), key.name << " does not reach the scene");
    ++count;
  }
  BOOST_TEST(count == 20);
}

BOOST_AUTO_TEST_CASE(a_key_reaches_its_own_member) {
  Scene scene;
  set_parameter(scene, "load.tension", 2.0);
  set_parameter(scene, "load.angle", 3.0);
  set_parameter(scene, "ends.shortening", 0.5);
  set_parameter(scene, "cylinder.friction", 0.3);
  BOOST_TEST(scene.load.tension == 2.0);
  BOOST_TEST(scene.load.angle == 3.0);
  BOOST_TEST(scene.ends.shortening.value() == 0.5);
  BOOST_TEST(scene.friction.value() == 0.3);
  BOOST_TEST(!scene.load.thrust.has_value());
  BOOST_TEST(get_parameter(scene, "load.thrust") == 0.0);  // not given
}

BOOST_AUTO_TEST_CASE(what_is_no_parameter_is_refused) {
  Scene scene;
  for (const char* name :
       {"title", "model.tolerance", "continuation.from", "rod.youngs_modulus", "nonsense"}) {
    BOOST_TEST(!is_numeric_key(name), name);
    BOOST_CHECK_THROW(set_parameter(scene, name, 1.0), SceneError);
    BOOST_CHECK_THROW(get_parameter(scene, name), SceneError);
  }
}

BOOST_AUTO_TEST_CASE(the_nearest_key_is_the_one_that_was_meant) {
  BOOST_TEST(nearest_key("load.tensoin") == "load.tension");
  BOOST_TEST(nearest_key("loads.tension") == "load.tension");
  BOOST_TEST(nearest_key("rod.tension") == "load.tension");  // the right word in the wrong table
  BOOST_TEST(nearest_key("tension") == "load.tension");
  BOOST_TEST(nearest_key("rod.lenght") == "rod.length");
  BOOST_TEST(nearest_key("continuation.maxpoints") == "continuation.max_points");
}

BOOST_AUTO_TEST_CASE(ranges) {
  const Range length = find_key("rod.length")->range;
  BOOST_TEST(length.contains(1e-3));
  BOOST_TEST(!length.contains(0.0));
  BOOST_TEST(length.contains(std::numeric_limits<double>::infinity()));
  BOOST_TEST(!length.contains(-std::numeric_limits<double>::infinity()));
  BOOST_TEST(!length.contains(std::nan("")));
  BOOST_TEST(length.text() == "> 0 or \"inf\"");
  const Range shortening = find_key("ends.shortening")->range;
  BOOST_TEST(shortening.contains(0.0));
  BOOST_TEST(!shortening.contains(2.0));
  BOOST_TEST(shortening.text() == ">= 0 and < 2");
  BOOST_TEST(!find_key("load.tension")->range.contains(std::numeric_limits<double>::infinity()));
}

BOOST_AUTO_TEST_CASE(defaults_are_those_of_the_struct) {
  BOOST_TEST(find_key("model.kind")->default_text() == "\"auto\"");
  BOOST_TEST(find_key("ends.kind")->default_text() == "\"moment_free\"");
  BOOST_TEST(find_key("continuation.max_points")->default_text() == "2000");
  BOOST_TEST(find_key("model.tolerance")->default_text() == "1e-08");
  BOOST_TEST(find_key("load.tension")->default_text() == "");
  BOOST_TEST(find_key("load.thrust")->default_text() == "");
}

BOOST_AUTO_TEST_SUITE_END()
