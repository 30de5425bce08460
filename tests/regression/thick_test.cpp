// Rods that touch themselves, as a user runs them: complete branches through every event, certified, both ways, half and full.

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

struct Coil {
  const char* scene;
  double length;
};
constexpr Coil one_turn{"capstan-2pi", 40.0}, two_turns{"capstan-4pi", 46.0};

std::vector<std::string> words(const std::string& command, const Coil& coil, double radius,
                               const std::vector<std::string>& settings) {
  std::vector<std::string> out = {command, shipped_scene(coil.scene)};
  const auto set = [&](const std::string& setting) { out.insert(out.end(), {"--set", setting}); };
  set("rod.self_contact=true");
  set("rod.radius=" + std::to_string(radius));
  set("rod.length=" + std::to_string(coil.length));
  for (const std::string& setting : settings) set(setting);
  return out;
}

/// Follows a coil in the tension in `folder`/run; every point passes its certificate, that of the virial among them.
Table follow(const TemporaryFolder& folder, const Coil& coil, double radius, double from, double to,
             const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings = {"continuation.from=" + std::to_string(from),
                                       "continuation.to=" + std::to_string(to)};
  settings.insert(settings.end(), more.begin(), more.end());
  std::vector<std::string> command = words("continue", coil, radius, settings);
  command.insert(command.end(), {"--out", "run", "--quiet", "--no-eigenvalues"});
  const Outcome outcome = run_program(command, folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err == "");  // neither lost, nor through itself
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
  return read_csv(folder.path() / "run" / "branches.csv");
}

std::vector<double> events(const Table& table) {
  std::vector<double> out;
  for (const auto& row : table.rows)
    if (row.at("type") == "contact") out.push_back(std::stod(row.at("T")));
  std::sort(out.begin(), out.end());
  return out;
}

nlohmann::json solved(const Coil& coil, double radius, const std::vector<std::string>& settings) {
  const TemporaryFolder folder;
  std::vector<std::string> command = words("solve", coil, radius, settings);
  command.push_back("--json");
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(thick_rods)

// One turn: from high tension on the crossing lies on the cylinder, leaves it, becomes one touch of mirror images, opens.
BOOST_AUTO_TEST_CASE(the_crossing_of_one_turn) {
  for (const double radius : {0.5, 2.0 / 7.0, 1.0 / 6.0}) {
    const TemporaryFolder down, up, full;
    const std::vector<double> first = events(follow(down, one_turn, radius, 20.0, 0.1));
    const std::vector<double> second = events(follow(up, one_turn, radius, 2.0, 20.0));
    const std::vector<double> third =
        events(follow(full, one_turn, radius, 20.0, 0.1, {"model.symmetry=none"}));
    BOOST_TEST(first.size() >= 3u);
    // Found from either side, and on either chain: located to 1e-8.
    for (const double event : second) {
      const auto same = [&](double other) { return std::abs(other - event) < 1e-8 * event; };
      BOOST_TEST(std::any_of(first.begin(), first.end(), same), "T = " << event << ", r = " << radius);
    }
    BOOST_TEST(first == third, boost::test_tools::tolerance(1e-8) << boost::test_tools::per_element());
  }
}

// Within 2e-4 of where the crossing leaves the cylinder an arc is 1e-5 long: what an old factorisation leaves of F is moments there.
BOOST_AUTO_TEST_CASE(certificates_hold_beside_an_event) {
  const TemporaryFolder folder;
  const Table table = follow(folder, one_turn, 1.0 / 6.0, 20.0, 5.0, {"rod.radius=0.16666666666666666"});
  BOOST_TEST(events(table).size() == 1u);
}

// A thin rod's branch turns at the flat coil and comes back as its own mirror image: distances are alike before and behind. The
// crossing is not jumped over.
BOOST_AUTO_TEST_CASE(strands_meet_before_the_coil_is_flat) {
  const double radius = 0.11319900384876613;
  const TemporaryFolder folder;
  const Table table = follow(folder, two_turns, radius, 0.3, 10.0,
                             {"rod.radius=0.11319900384876613", "load.angle=2 pi", "rod.length=42"});
  for (const auto& row : table.rows)
    if (!row.at("self_distance").empty())
      BOOST_TEST(std::stod(row.at("self_distance")) > 2.0 * radius - 1e-9);  // what certificates ask
  BOOST_TEST(table.rows.back().at("topology") == "tail cross gap line gap cross tail");
}

// A clamped tail's last element, of 25 decay lengths and more, may begin only where the rod is straight.
BOOST_AUTO_TEST_CASE(a_clamped_tail_is_resolved_while_it_is_bent) {
  const TemporaryFolder folder;
  const Table table = follow(folder, one_turn, 0.1559, 10.0, 3.0, {"ends.kind=clamped", "rod.length=42"});
  BOOST_TEST(std::stod(table.rows.back().at("T")) == 3.0);
}

// Two turns: each tail presses on the strand that it lies over, and under high tension the turns lie side by side.
BOOST_AUTO_TEST_CASE(two_turns_from_high_tension_down) {
  const std::string
      apart = "tail cross gap line cross line cross line gap cross tail",
      side_by_side =
          "tail cross gap line cross lines cross line cross line cross line cross lines cross line "
          "gap cross tail";
  for (const double radius : {1.0 / 6.0, 2.0 / 7.0, 0.5}) {
    const TemporaryFolder folder;
    const Table table = follow(folder, two_turns, radius, 10.0, 0.3);
    BOOST_TEST(table.rows.front().at("topology") == (radius < 0.2 ? apart : side_by_side));
    BOOST_TEST(std::stod(table.rows.back().at("T")) == 0.3);
  }
}

// Turns meet at a point, which widens to a line at once: both found from either side and on either chain, and the states agree.
BOOST_AUTO_TEST_CASE(turns_come_to_lie_side_by_side) {
  const double radius = std::stod(std::to_string(2.0 / 7.0));  // as it is given to the program
  const TemporaryFolder up, down, full;
  const Table rising = follow(up, two_turns, radius, 5.0, 7.0),
              falling = follow(down, two_turns, radius, 7.0, 5.0),
              whole = follow(full, two_turns, radius, 5.0, 7.0, {"model.symmetry=none"});
  BOOST_TEST(events(rising).size() == 2u);
  BOOST_TEST(events(rising) == events(falling), boost::test_tools::tolerance(1e-8)
                                                    << boost::test_tools::per_element());
  BOOST_TEST(events(rising) == events(whole), boost::test_tools::tolerance(1e-8)
                                                  << boost::test_tools::per_element());
  const auto strength = [](const auto& row) { return std::stod(row.at("R_tot")); };
  // The touches of a line make less than 1e-11 of it, however many there are.
  BOOST_TEST(strength(rising.rows.back()) == strength(falling.rows.front()),
             boost::test_tools::tolerance(1e-10));
  BOOST_TEST(strength(rising.rows.back()) == strength(whole.rows.back()),
             boost::test_tools::tolerance(1e-10));
  for (const auto& row : rising.rows)
    if (row.at("topology").find("lines") != std::string::npos && row.at("type") == "regular")
      BOOST_TEST(std::stod(row.at("self_distance")) == 2.0 * radius, boost::test_tools::tolerance(2e-9));
}

// At other radii they touch at a point for a while, in 1e-4 of the tension; beside forces of 1e-8 in their lines.
BOOST_AUTO_TEST_CASE(turns_that_touch_at_a_point_first) {
  const double radius = 0.2;
  const TemporaryFolder up, down;
  const std::vector<double> rising = events(follow(up, two_turns, radius, 9.0, 10.0)),
                            falling = events(follow(down, two_turns, radius, 10.0, 9.0));
  BOOST_TEST(rising.size() == 3u);
  BOOST_TEST(rising == falling, boost::test_tools::tolerance(1e-8) << boost::test_tools::per_element());
}

// Where an arc beside a touch vanishes the event's own state has an arc without length, and the branch goes on a little
// beyond: a run from there, and targets in between.
BOOST_AUTO_TEST_CASE(a_run_begins_at_an_event_and_ends_beside_it) {
  struct Case {
    Coil coil;
    double radius, from;
  };
  for (const Case& c : {Case{one_turn, 2.0 / 7.0, 13.0}, Case{two_turns, 1.0 / 6.0, 2.6}}) {
    const TemporaryFolder folder;
    const Table table = follow(folder, c.coil, c.radius, c.from, 0.9 * c.from);
    const std::vector<double> found = events(table);
    BOOST_REQUIRE(!found.empty());
    const double event = found.back();
    for (const double beyond : {3e-6, 1e-4, 3e-3}) {
      const Outcome outcome =
          run_program({"continue", "run", "E1", "--set", "continuation.to=" + std::to_string(event - beyond),
                       "--out", "beside", "--force", "--quiet", "--no-eigenvalues"},
                      folder.path());
      BOOST_TEST_CONTEXT("radius " << c.radius << ", " << beyond << " below " << event) {
        BOOST_TEST(outcome.status == 0, outcome.err);
        const Table beside = read_csv(folder.path() / "beside" / "branches.csv");
        BOOST_TEST(std::abs(std::stod(beside.rows.back().at("T")) - (event - beyond)) < 1e-6);  // as printed
        BOOST_TEST(beside.rows.size() <= 8u);
      }
    }
  }
}

// A touch of a free strand right behind an edge flattens beside a line and joins it; the line's end then passes the edge.
BOOST_AUTO_TEST_CASE(a_touch_joins_the_line_beside_it) {
  const TemporaryFolder folder;
  const Table up = follow(folder, two_turns, 1.0 / 4.35, 9.4, 9.7);
  const std::vector<double> found = events(up);
  BOOST_REQUIRE(found.size() == 2u);
  BOOST_TEST(found[0] == 9.485389, boost::test_tools::tolerance(1e-6));
  // Strands 8e-10 nearer than they touch move a line's end by the root of that over their curvature, and this event with it.
  BOOST_TEST(found[1] == 9.528, boost::test_tools::tolerance(1e-3));
}

// The same the other way, on lines with other touches: the line opens behind its end, and what is found both ways differs by no more
// than the printed precision, which holds what the touches of the lines move.
BOOST_AUTO_TEST_CASE(a_line_opens_behind_its_end) {
  const TemporaryFolder down, up;
  follow(down, two_turns, 1.0 / 4.35, 9.6, 8.2);
  follow(up, two_turns, 1.0 / 4.35, 8.2, 9.6);
  const auto special = [](const TemporaryFolder& folder) {
    std::ifstream file(folder.path() / "run" / "special_points.json");
    return nlohmann::json::parse(file);
  };
  const auto number = [](const nlohmann::json& of, const char* key) { return of.at(key).get<double>(); };
  const auto first = special(down), second = special(up);
  BOOST_TEST(first.size() == 4u);
  for (const auto& event : first) {
    const auto same = [&](const nlohmann::json& other) {
      return std::abs(number(event, "T") - number(other, "T")) <=
             number(event, "precision") + number(other, "precision");
    };
    BOOST_TEST(std::any_of(second.begin(), second.end(), same), "T = " << number(event, "T"));
    BOOST_TEST(number(event, "precision") < 1e-3 * number(event, "T"));
  }
}

// A touch whose curvature vanishes goes on as the same touch while it stands for the line that has come from it: the branch has no hole
// behind the event, targets right beside it are met from both sides, and the event is the same both ways.
BOOST_AUTO_TEST_CASE(a_touch_carries_the_line_that_comes_from_it) {
  const std::vector<std::string> coil = {"ends.kind=clamped", "load.angle=3.7896 pi", "rod.length=32.765"};
  const TemporaryFolder up, down;
  const std::vector<double> rising = events(follow(up, two_turns, 0.5, 7.7, 8.0, coil)),
                            falling = events(follow(down, two_turns, 0.5, 8.0, 7.7, coil));
  BOOST_REQUIRE(rising.size() == 1u);
  BOOST_REQUIRE(falling.size() == 1u);
  BOOST_TEST(rising[0] == falling[0], boost::test_tools::tolerance(1e-8));
  for (const double beyond : {1e-5, 1e-3, 1e-2, 2e-2}) {  // the line is redrawn 0.014 beyond
    const TemporaryFolder folder;
    const Table table = follow(folder, two_turns, 0.5, 7.7, rising[0] + beyond, coil);
    BOOST_TEST(std::stod(table.rows.back().at("T")) == rising[0] + beyond,
               boost::test_tools::tolerance(1e-6));
  }
}

// Two touches 3e-5 apart hold nearly the same: one force between them costs nothing and moves nothing.
BOOST_AUTO_TEST_CASE(spectra_of_touches_next_to_each_other) {
  const TemporaryFolder folder;
  follow(folder, one_turn, 1.0 / 6.0, 9.95, 9.9);
  const Outcome outcome = run_program({"stability", "run", "--json"}, folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  const auto spectra = nlohmann::json::parse(outcome.out);
  for (const auto& point : spectra.at("points")) {
    BOOST_TEST(point.at("index") == 0);
    BOOST_TEST(point.at("inertia_index") == 0);
    // The pull's slowest mode, a twist of the tails: the same all along.
    BOOST_TEST(point.at("eigenvalues")[0].get<double>() == 0.004112, boost::test_tools::tolerance(1e-3));
  }
}

// A touch passes the edge of a line: the arc between has no length there, and no weight. The spectrum goes on through the event.
BOOST_AUTO_TEST_CASE(the_spectrum_at_an_arc_without_length) {
  const TemporaryFolder folder;
  follow(folder, one_turn, 0.5, 5.0, 5.6);
  const Outcome spectra = run_program({"stability", "run", "--json"}, folder.path());
  BOOST_REQUIRE_MESSAGE(spectra.status == 0, spectra.err);
  const auto points = nlohmann::json::parse(spectra.out)["points"];
  int events = 0;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    if (points[k]["name"].get<std::string>().front() != 'E') continue;
    ++events;
    BOOST_TEST(points[k]["degenerate"] == true);
    BOOST_TEST(points[k]["index"] == 0);
    BOOST_TEST(points[k]["eigenvalues"].size() == 6u);
    // The second one rises with the tension all the way.
    const auto second = [&](std::size_t at) { return points[at]["eigenvalues"][1].get<double>(); };
    BOOST_TEST(second(k - 1) < second(k));
    BOOST_TEST(second(k) < second(k + 1));
  }
  BOOST_TEST(events == 1);
}

// Below T = 0.2839 the thin flat coil lifts off; the thick one stays, and a branch starts in the state that `solve` finds.
BOOST_AUTO_TEST_CASE(a_branch_starts_where_solve_ends) {
  constexpr double radius = 2.0 / 7.0;
  const TemporaryFolder down;
  const std::vector<double> first = events(follow(down, one_turn, radius, 1.0, 0.1));
  for (const double tension : {0.2, 0.1}) {
    const TemporaryFolder up;
    const Table table = follow(up, one_turn, radius, tension, 1.0);
    const auto alone = solved(one_turn, radius, {"load.tension=" + std::to_string(tension)});
    // Two ways to one state: what differs is the error of their meshes.
    BOOST_TEST(std::stod(table.rows.front().at("R_tot")) == alone.at("R_tot").get<double>(),
               boost::test_tools::tolerance(1e-10));
    BOOST_TEST(events(table) == first, boost::test_tools::tolerance(1e-8)
                                           << boost::test_tools::per_element());
  }
}

// A thinner and thinner rod is the thin one: R_tot differs by the square of the radius.
BOOST_AUTO_TEST_CASE(the_limit_of_a_thin_rod) {
  const double thin = solved(one_turn, 0.0, {"rod.self_contact=false", "load.tension=2"}).at("R_tot");
  const auto beyond = [&](double radius) {
    return solved(one_turn, radius, {"load.tension=2"}).at("R_tot").get<double>() - thin;
  };
  BOOST_TEST(beyond(0.02) / beyond(0.01) == 4.0, boost::test_tools::tolerance(0.01));
}

BOOST_AUTO_TEST_CASE(half_and_full_chains_agree) {
  for (const double tension : {0.3, 1.2, 2.0, 8.0, 16.0}) {
    const std::string load = "load.tension=" + std::to_string(tension);
    const auto half = solved(one_turn, 0.25, {load}),
               full = solved(one_turn, 0.25, {load, "model.symmetry=none"});
    for (const char* key : {"R_tot", "self_force", "energy"})
      BOOST_TEST(half.at(key).get<double>() == full.at(key).get<double>(),
                 boost::test_tools::tolerance(1e-9));
    BOOST_TEST(half["stability"]["index"] == full["stability"]["index"]);
    BOOST_TEST(half["contact"]["self"].size() == full["contact"]["self"].size());
  }
}

// A strut twisted by two turns loops out and touches itself.
BOOST_AUTO_TEST_CASE(a_twisted_strut_touches_itself) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      {"continue", shipped_scene("strut-twisted-thick"), "--out", "run", "--quiet", "--no-eigenvalues"},
      folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err == "");  // nowhere through itself
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
  const Table table = read_csv(folder.path() / "run" / "branches.csv");
  BOOST_TEST(table.rows.back().at("topology") == "tail cross gap cross tail");
  for (const auto& row : table.rows)
    if (row.at("type") == "contact")
      BOOST_TEST(std::stod(row.at("shortening")) == 0.2485081523, boost::test_tools::tolerance(1e-8));
  // The loop pulls at the touch: its force grows from nothing, and the rod stays 2r from itself.
  for (const auto& row : table.rows)
    if (row.at("topology") == "tail cross gap cross tail" && row.at("type") == "regular") {
      BOOST_TEST(std::stod(row.at("self_force")) > 0.0);
      BOOST_TEST(std::stod(row.at("self_distance")) == 0.02, boost::test_tools::tolerance(1e-9));
    }
}

BOOST_AUTO_TEST_CASE(what_cannot_touch_itself_is_refused) {
  const TemporaryFolder folder;
  const auto message = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> command = {"solve", shipped_scene("capstan-2pi")};
    for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
    const Outcome outcome = run_program(command, folder.path());
    BOOST_TEST(outcome.status == 1);
    return outcome.err;
  };
  const std::string contact = "rod.self_contact=true", radius = "rod.radius=0.2";
  BOOST_TEST(message({contact}).find("rod.radius") != std::string::npos);
  BOOST_TEST(message({contact, radius, "rod.length=inf"}).find("rod.self_contact") != std::string::npos);
  BOOST_TEST(message({contact, radius, "model.kind=planar"}).find("rod.self_contact") != std::string::npos);
  BOOST_TEST(message({contact, "rod.radius=1"}).find("rod.radius") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
