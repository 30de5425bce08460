// A cylinder that slides through a rod whose friction has a moment about the centre line.

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "regression/sliding.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

BOOST_AUTO_TEST_SUITE(sliding_with_moment)

BOOST_AUTO_TEST_CASE(friction_has_its_moment_at_touches) {
  const TemporaryFolder folder;
  const std::vector<std::string> thick = on_touches({"rod.radius=0.2857142857142857"});
  const nlohmann::json all = solved(thick);
  BOOST_REQUIRE(all["states"].size() == 2u);  // beside the flat coil
  const nlohmann::json& state = all["states"][1];
  BOOST_TEST(state["index"] == 0);
  // Travel is blocked: the drag is along the axis.
  const double drag = state["F0"].get<double>();
  BOOST_TEST(std::abs(drag / (0.32 * state["R_tot"].get<double>()) - 1.0) < 1e-10);
  // Two per cent more than without.
  const nlohmann::json without =
      solved(on_touches({"rod.radius=0.2857142857142857", "cylinder.friction_couple=false"}));
  const nlohmann::json thin = solved(on_touches({}));
  BOOST_REQUIRE(without["states"].size() == 2u);
  BOOST_TEST(without["states"][1]["F0"] == thin["states"][1]["F0"]);
  const double excess = drag / thin["states"][1]["F0"].get<double>() - 1.0;
  BOOST_TEST(excess > 0.01);
  BOOST_TEST(excess < 0.04);
  // Down in tension; and up, to where a line would begin.
  std::vector<std::string> down = thick, up = thick;
  down.insert(down.end(), {"continuation.from=0.3", "continuation.to=0.2"});
  up.insert(up.end(), {"continuation.from=0.3", "continuation.to=0.6"});
  BOOST_TEST(followed((folder / "down").string(), down).empty());
  const auto ends = followed((folder / "up").string(), up);
  BOOST_REQUIRE(ends.size() == 1u);
  BOOST_TEST(ends[0]["after"].get<std::string>().find("not built for lines") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(friction_has_its_moment_along_a_line) {
  const TemporaryFolder folder;
  std::vector<std::string> lying = on_touches({"rod.radius=0.1", "cylinder.friction=0.2"});
  lying.push_back("load.tension=0.45");
  const nlohmann::json all = solved(lying);
  BOOST_REQUIRE(all["states"].size() == 3u);  // the flat coil is the first
  const nlohmann::json& state = all["states"][1];
  BOOST_REQUIRE(state["topology"] == "tail line gap touch:2 tail");
  BOOST_TEST(state["index"] == 0);
  // Travel is blocked: the drag is along the axis.
  BOOST_TEST(std::abs(state["F0"].get<double>() / (0.2 * state["R_tot"].get<double>()) - 1.0) < 1e-10);
  // Past the tensions at which gaps open in the line, one of them beside the layer of its pressure, whose edge has no other force;
  // every state is certified.
  lying.insert(lying.end(), {"continuation.from=0.45", "continuation.to=0.43"});
  const auto events = followed((folder / "run").string(), lying);
  BOOST_REQUIRE(events.size() == 3u);
  BOOST_TEST(events[0]["after"] == "tail line gap line gap touch:2 tail");
  BOOST_TEST(events[1]["after"] == "tail touch gap line gap touch:2 tail");
  BOOST_TEST(events[2]["after"] == "tail touch gap line gap line gap touch:2 tail");
}

BOOST_AUTO_TEST_CASE(a_moment_that_cannot_be_honoured_is_refused) {
  const TemporaryFolder folder;
  const std::vector<std::string> thick = on_touches({"rod.radius=0.2857142857142857"});
  // Tails that cross would press on each other, twisted; a plate that ends lets them rise; between touches a rod is twisted where
  // only one end holds the spin.
  for (const auto& [setting, why, status] :
       {std::tuple{"ends.kind=moment_free", "nothing balances the moment", 1},
        {"rod.self_contact=true", "its tails would cross", 2},
        {"plate.outer_radius=3", "plate.outer_radius lets rise", 2},
        {"ends.right=moment_free", "both ends' spin held", 2}}) {
    std::vector<std::string> settings = thick;
    settings.push_back(setting);
    settings.push_back("cylinder.friction_couple=true");
    if (setting != std::string("ends.right=moment_free")) settings.push_back("load.tension=1");
    const Outcome outcome = run_program(sliding("solve", settings), folder.path());
    BOOST_TEST(outcome.status == status);
    BOOST_TEST(outcome.err.find(why) != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_CASE(between_ends_that_turn_freely_there_is_none_unless_it_is_asked_for) {
  const std::vector<std::string> thick = {"rod.radius=0.2", "load.angle=pi"};
  std::vector<std::string> without = thick;
  without.push_back("cylinder.friction_couple=false");
  const nlohmann::json state = solved(thick), told = solved(without);
  BOOST_TEST(state["F0"] == told["F0"]);
  const auto says = [](const nlohmann::json& of) {
    return of["model_reason"].get<std::string>().find("no moment about the centre line") != std::string::npos;
  };
  BOOST_TEST(says(state));
  BOOST_TEST(!says(told));
}

BOOST_AUTO_TEST_CASE(a_flat_coil_has_the_moment_of_the_friction) {
  // M = ∓ ½ r mu R_tot in the tails, which the plate presses with M θ″: the coil stays in the plane, and F0 is that of the thin rod.
  // Lines, touches and a single touch; both ends held, or one; a rod that stretches; a thick one whose tails do not cross.
  const TemporaryFolder folder;
  const double mu = 0.32;
  int number = 0;
  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {},
           {"model.kind=planar"},
           {"load.tension=0.4"},
           {"load.angle=pi", "load.tension=2", "rod.self_contact=true"},
           {"load.angle=0.5 pi", "rod.self_contact=true"},
           {"ends.kind=moment_free", "ends.left=clamped"},
           // Samples of the tails far enough apart for more than half a turn.
           {"load.angle=4 pi", "load.tension=14", "rod.length=48"},
           {"rod.extensible=true", "rod.length=20", "load.tension=0.7"}}) {
    std::vector<std::string> all = {"rod.radius=0.2857142857142857", "rod.self_contact=false",
                                    "ends.kind=spin_held"};
    all.insert(all.end(), settings.begin(), settings.end());
    const std::string run = (folder / std::to_string(number++)).string();
    std::vector<std::string> words = sliding("solve", all);
    words.insert(words.end(), {"--out", run, "--json"});
    const Outcome outcome = run_program(words, folder.path());
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const nlohmann::json state = nlohmann::json::parse(outcome.out);
    BOOST_TEST(state["stability"]["index"] == 0);
    const double total = state["R_tot"].get<double>();
    BOOST_TEST(std::abs(state["F0"].get<double>() / (mu * total) - 1.0) < 1e-12);
    BOOST_TEST(std::abs(state["plate"]["force"].get<double>() / (mu * total) - 1.0) < 1e-12);
    // Integrated again with the moment: balance, frames of the ends, nowhere pulled by the plate.
    BOOST_TEST(run_program({"verify", run}, folder.path()).status == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
