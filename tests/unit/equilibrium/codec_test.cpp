// What a checkpoint keeps of a rod's problem: read back it is what was written, also what is not known yet.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/equilibrium/codec.hpp"
#include "windlass/equilibrium/start.hpp"

using namespace windlass;
using equilibrium::RodProblem;

BOOST_AUTO_TEST_SUITE(codec)

BOOST_AUTO_TEST_CASE(what_a_problem_remembers_is_kept) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.load.tension = 2.0;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 30.0;
  const equilibrium::Started start = equilibrium::cold_start(scene, true, true, {"load.tension"});
  const continuation::ProblemCodec codec = equilibrium::rod_codec(scene, {"load.tension"});
  for (const std::optional<int> reference : {std::optional<int>(), std::optional(0), std::optional(-1)}) {
    RodProblem::Memory memory = start.problem->memory();
    memory.index = 2, memory.breaking_index = 1, memory.error = 3e-12;
    memory.slides = true, memory.sliding_off = 1, memory.sliding_reference = reference;
    start.problem->remember(memory);
    const nlohmann::json written = codec.encode(*start.problem);
    const auto read = std::dynamic_pointer_cast<RodProblem>(codec.decode(written));
    BOOST_REQUIRE(read);
    BOOST_TEST((read->memory().sliding_reference == reference));
    BOOST_TEST(codec.encode(*read) == written);
    const auto copy = std::dynamic_pointer_cast<RodProblem>(start.problem->clone());
    BOOST_TEST(codec.encode(*copy) == written);
  }
}

BOOST_AUTO_TEST_SUITE_END()
