// Two plates, one on each side of the rod, as a user has them computed.

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

using Settings = std::vector<std::string>;
using Row = std::map<std::string, std::string>;

Settings asked(const std::string& command, const std::string& scene, const Settings& settings) {
  Settings out = {command, scene};
  for (const std::string& setting : settings) out.insert(out.end(), {"--set", setting});
  return out;
}

nlohmann::json between(const std::string& scene, const Settings& settings) {
  Settings command = asked("solve", scene, settings);
  command.push_back("--json");
  const TemporaryFolder folder;
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

/// The points of a branch, all of which pass their certificates, and its special points.
struct Squeezed {
  std::vector<Row> rows;
  nlohmann::json special;
};
Squeezed squeezed(const Settings& command, const std::string& run) {
  const TemporaryFolder folder;
  Settings all = command;
  all.insert(all.end(), {"--out", run, "--quiet", "--no-eigenvalues"});
  const Outcome outcome = run_program(all, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const Outcome verified = run_program({"verify", run}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
  return {read_csv(run + "/branches.csv").rows,
          nlohmann::json::parse(std::ifstream(run + "/special_points.json"))};
}

double at(const Row& row, const char* key) { return std::stod(row.at(key)); }

constexpr const char* free_of_both = "tail line gap touch:2 tail";

/// A helix without friction, T = 1, between two plates.
const std::string helix = R"([rod]
length = 30
[cylinder]
[[plate]]
height = 2
[[plate]]
height = -2
[load]
tension = 1
angle = "2 pi"
)";

}  // namespace

BOOST_AUTO_TEST_SUITE(two_plates)

BOOST_AUTO_TEST_CASE(a_second_plate_far_away_changes_nothing) {
  const std::string scene = shipped_scene("capstan-2pi-plate");
  const Settings low = {"load.tension=0.57", "cylinder.friction=0.1"};
  Settings two = low;
  two.push_back("plate.2.height=-8");
  const nlohmann::json one = between(scene, low), both = between(scene, two);
  BOOST_TEST((one["states"] == both["states"]));  // to the last digit
  BOOST_TEST((one["plate"] == both["plate"]));
  BOOST_TEST(!one.contains("plates"));
  BOOST_REQUIRE(both["plates"].size() == 2u);
  BOOST_TEST(both["plates"][1]["force"] == 0.0);
  BOOST_TEST(both["plates"][1]["height"] == -8.0);
}

BOOST_AUTO_TEST_CASE(a_dragged_helix_is_squeezed_to_a_fold_and_comes_back) {
  const TemporaryFolder folder;
  const auto [rows, special] =
      squeezed({"continue", shipped_scene("capstan-2pi-two-plates")}, (folder / "down").string());
  // The lowest place of the free helix is the end of its lower tail: it is met there, to what locating is asked for.
  BOOST_REQUIRE(special.size() == 5u);
  const double met = special[0]["parameter"];
  BOOST_TEST(rows.front().at("topology") == free_of_both);
  BOOST_TEST(std::abs(met + at(rows.front(), "z_span")) < 1e-9);
  const std::vector<std::string> types = {"contact", "contact", "fold", "contact", "contact"};
  for (std::size_t k = 0; k < types.size(); ++k) BOOST_TEST(special[k]["type"] == types[k]);
  BOOST_TEST(special[0]["after"] == "end:3 tail line gap touch:2 tail");
  BOOST_TEST(special[1]["after"] == "tail touch:3 gap line gap touch:2 tail");
  BOOST_TEST(special[4]["after"] == free_of_both);
  // Beside one plate there are two such states; the fold is where they are one. The way back ends on the other.
  const nlohmann::json free =
      between(shipped_scene("capstan-2pi-plate"), {"load.tension=0.57", "cylinder.friction=0.1"});
  BOOST_REQUIRE(free["states"].size() == 3u);
  constexpr double solved = 1e-9;
  for (const auto& [row, state] : {std::pair{rows.front(), 1}, {rows.back(), 2}})
    BOOST_TEST(std::abs(at(row, "F0") / free["states"][state]["F0"].get<double>() - 1.0) < solved);
  // The upper plate carries the drag and the push of the lower one; plate_force is the sum of both. The tilt falls up to the fold.
  double tilt = HUGE_VAL;
  for (const Row& row : rows) {
    if (row.at("type") == "fold") break;
    BOOST_TEST(at(row, "tilt") <= tilt + 1e-12);
    BOOST_TEST(at(row, "plate_force") >= at(row, "F0") - 1e-12);
    tilt = at(row, "tilt");
  }
}

BOOST_AUTO_TEST_CASE(upward_the_events_are_the_same) {
  const TemporaryFolder folder;
  const std::string scene = shipped_scene("capstan-2pi-two-plates");
  const Settings down = {"continuation.to=-1.9"}, up = {"continuation.from=-1.9", "continuation.to=-2.5"};
  const nlohmann::json there = squeezed(asked("continue", scene, down), (folder / "down").string()).special,
                       back = squeezed(asked("continue", scene, up), (folder / "up").string()).special;
  BOOST_REQUIRE(there.size() == 2u);
  BOOST_REQUIRE(back.size() == 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    BOOST_TEST(there[k]["before"] == back[1 - k]["after"]);
    const double apart = there[k]["parameter"].get<double>() - back[1 - k]["parameter"].get<double>();
    BOOST_TEST(std::abs(apart) < 1e-9);  // each is printed with a precision of 3e-10 or less
  }
  const nlohmann::json state = between(scene, {"plate.2.height=-1.5"});
  const auto squeezed_state = std::find_if(
      state["states"].begin(), state["states"].end(),
      [](const auto& one) { return one["topology"] == "tail touch:3 gap line gap touch:2 tail"; });
  BOOST_TEST((squeezed_state != state["states"].end()));
}

BOOST_AUTO_TEST_CASE(without_friction_the_helix_is_pressed_flat) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("helix.toml", helix);
  const std::string diagram = (folder / "diagram").string();
  squeezed(asked("diagram", scene, {"continuation.from=2", "continuation.to=1"}), diagram);
  const Row start = read_csv(diagram + "/branches.csv").rows.back();
  const std::string point = start.at("branch") + "-" + start.at("point");
  const auto [rows, special] =
      squeezed({"continue", diagram, point, "--set", "continuation.parameter=plate.2.height", "--set",
                "continuation.to=1.99"},
               (folder / "down").string());
  // It floats: it touches both plates at once, where they are as far apart as it is high.
  BOOST_REQUIRE(special.size() == 2u);
  BOOST_TEST(special[0]["after"] == "end:3 tail line tail end:2");
  BOOST_TEST(special[1]["after"] == "tail touch:3 gap line gap touch:2 tail");
  BOOST_TEST(std::abs(2.0 - special[0]["parameter"].get<double>() - at(rows.front(), "z_span")) < 1e-9);
  // The flat coil's R_tot = (2T − 1) phi_star + √(4T − 1), which by itself is unstable; what is added goes with the square of the
  // height that is left, 0.01, by 0.33 of it.
  const double flat = M_PI - std::acos(0.5) + std::sqrt(3.0), height = 0.01;
  const double rest = at(rows.back(), "R_tot") - flat;
  BOOST_TEST(rest > 0.0);
  BOOST_TEST(rest < 0.5 * height * height);
  BOOST_TEST(std::abs(at(rows.back(), "z_span") - height) < 1e-9);
  for (const Row& row : rows) BOOST_TEST(row.at("index") == "0");
}

BOOST_AUTO_TEST_CASE(thick_rods_are_squeezed_down_to_two_strands) {
  const TemporaryFolder folder;
  const std::string scene = shipped_scene("capstan-2pi-plate-thick");
  const Settings down = {"load.tension=1", "plate.2.height=-0.8", "continuation.parameter=plate.2.height",
                         "continuation.from=-0.8", "continuation.to=-0.58"};
  const auto [rows, special] = squeezed(asked("continue", scene, down), (folder / "thick").string());
  BOOST_REQUIRE(special.size() == 1u);
  BOOST_TEST(std::abs(special[0]["parameter"].get<double>() + at(rows.front(), "z_span")) < 1e-9);
  BOOST_TEST(at(rows.back(), "self_force") >
             1.0);  // strands of radius 2/7 in a room of 0.58: 0.0086 are left
}

BOOST_AUTO_TEST_CASE(a_stored_point_goes_on_in_tension_where_the_plate_was) {
  const TemporaryFolder folder;
  const std::string down = (folder / "down").string();
  const Settings to = {"continuation.to=-1.9"};
  const Row last = squeezed(asked("continue", shipped_scene("capstan-2pi-two-plates"), to), down).rows.back();
  const auto [rows, special] =
      squeezed({"continue", down, last.at("branch") + "-" + last.at("point"), "--set",
                "continuation.parameter=load.tension", "--set", "continuation.to=0.58"},
               (folder / "tension").string());
  for (const Row& row : rows) BOOST_TEST(std::abs(at(row, "z_span") - 1.9) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_clove_hitch_is_squeezed_too) {
  const TemporaryFolder folder;
  const Settings down = {"load.tension=0.3", "continuation.parameter=plate.2.height", "continuation.from=-3",
                         "continuation.to=-2.7"};
  const auto [rows, special] =
      squeezed(asked("continue", shipped_scene("clove-hitch-plate"), down), (folder / "hitch").string());
  // Its lowest place is no end: an ordinary touch, where the free one's height says; then a strand lies along the upper plate.
  BOOST_REQUIRE(special.size() == 2u);
  BOOST_TEST(std::abs(special[0]["parameter"].get<double>() + at(rows.front(), "z_span")) < 1e-9);
  BOOST_TEST(rows.back().at("topology").find("touch:3") != std::string::npos);
  BOOST_TEST(rows.back().at("topology").find("line:2") != std::string::npos);
  BOOST_TEST(at(rows.back(), "plate_force") > at(rows.back(), "F0"));
}

BOOST_AUTO_TEST_CASE(a_second_plate_that_ends_is_met_at_its_edge) {
  const TemporaryFolder folder;
  const Settings down = {"plate.2.outer_radius=3", "continuation.to=-1.4"};
  const auto [rows, special] =
      squeezed(asked("continue", shipped_scene("capstan-2pi-two-plates"), down), (folder / "edge").string());
  BOOST_REQUIRE(special.size() == 2u);  // the tail rests on the edge, then on the plate
  BOOST_TEST(special[0]["after"] == "tail touch:4 gap line gap touch:2 tail");
  BOOST_TEST(special[1]["after"] == "tail touch:3 gap line gap touch:2 tail");
}

BOOST_AUTO_TEST_CASE(what_two_plates_cannot_be_is_refused_with_key_and_reason) {
  const auto says = [](const std::string& command, const std::string& scene, const Settings& settings,
                       const std::vector<std::string>& words) {
    const TemporaryFolder folder;
    const Outcome outcome = run_program(asked(command, scene, settings), folder.path());
    BOOST_TEST(outcome.status == 1);
    for (const std::string& word : words)
      BOOST_TEST((outcome.err.find(word) != std::string::npos), word << " in " << outcome.err);
  };
  const std::string one = shipped_scene("capstan-2pi-plate"), two = shipped_scene("capstan-2pi-two-plates");
  says("solve", two, {"plate.2.height=0.5"}, {"plate.2.height = 0.5", "must be < 0", "no room"});
  says("solve", two, {"plate.2.side=above"}, {"plate.2.side", "must be \"below\""});
  says("solve", two, {"ends.kind=clamped"}, {"ends.kind", "two plates"});
  says("solve", shipped_scene("capstan-2pi-plate-thick"), {"plate.2.height=-0.5"},
       {"plate.2.height = -0.5", "2 rod.radius"});
  says("continue", one, {"continuation.parameter=plate.2.height"}, {"plate.2.height", "second"});
}

BOOST_AUTO_TEST_SUITE_END()
