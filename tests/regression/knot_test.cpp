// Knots as a user ties them: from nothing, through changes of contact, certified, half and full, against a discrete rod.

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/certified_run.hpp"
#include "support/csv.hpp"
#include "support/fit_of.hpp"
#include "support/run_program.hpp"
#include "windlass/discrete_rod/thick_minimiser.hpp"
#include "windlass/knot/start_curve.hpp"

using namespace windlass::test;

namespace {

std::vector<std::string> tied(const std::string& command, double radius,
                              const std::vector<std::string>& settings) {
  std::vector<std::string> out = {command, shipped_scene("clove-hitch"), "--set",
                                  "rod.radius=" + std::to_string(radius)};
  for (const std::string& setting : settings) out.insert(out.end(), {"--set", setting});
  return out;
}

nlohmann::json solved(double radius, double tension, const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings = {"load.tension=" + std::to_string(tension)};
  settings.insert(settings.end(), more.begin(), more.end());
  std::vector<std::string> command = tied("solve", radius, settings);
  command.insert(command.end(), {"--json", "--quiet"});  // no progress, however busy the machine is
  const TemporaryFolder folder;
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE(outcome.status == 0);
  BOOST_TEST(outcome.err == "");
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(knots)

BOOST_AUTO_TEST_CASE(clove_hitch_agrees_with_the_discrete_rod) {
  // Shares no code with the chain but the curve that both start on. Its finest mesh is off by its bed: 1e-3.
  constexpr double radius = 0.285714;
  for (const double tension : {0.3, 1.0, 2.0}) {
    const nlohmann::json state = solved(radius, tension);
    BOOST_TEST(state["stability"]["index"] == 0);
    windlass::discrete_rod::ThickRod rod{tension, 4.0 * M_PI, 30.0, radius};
    rod.curve = windlass::knot::clove_hitch(radius);
    rod.fine_length = 2.0 * M_PI + 3.0;
    const auto limit = windlass::discrete_rod::minimise(rod, {0.14, 0.1, 0.07});
    BOOST_REQUIRE(limit.converged);
    BOOST_TEST(std::abs(limit.R_tot / state["R_tot"].get<double>() - 1.0) < 1e-3);
    const double self = state["self_force"].get<double>();
    BOOST_TEST(std::abs(limit.self_force / self - 1.0) < 1e-2);
  }
}

BOOST_AUTO_TEST_CASE(clove_hitch_loosens_through_every_change_of_contact) {
  for (const double radius : {0.5, 0.285714, 0.166667}) {
    const TemporaryFolder folder;
    const Table table = certified_run(  // by the virial among others
        tied("continue", radius, {"continuation.from=1", "continuation.to=0.1"}), folder);
    BOOST_TEST(std::stod(table.rows.back().at("T")) == 0.1);
    for (const auto& row : table.rows) BOOST_TEST(row.at("index") == "0");
  }
}

BOOST_AUTO_TEST_CASE(a_branch_begins_where_it_is_asked_to) {
  // Relaxed at T = 2, inside the branch, the hitch is followed to where the branch begins; what it met on the way is reported
  // from there, as what follows is.
  const TemporaryFolder folder;
  const Table table =
      certified_run(tied("continue", 0.285714, {"continuation.from=3", "continuation.to=1.6"}), folder);
  BOOST_TEST(table.rows.front().at("type") == "start");
  BOOST_TEST(table.rows.front().at("T") == "3");
  BOOST_TEST(table.rows.back().at("T") == "1.6");
  int events = 0;
  double last = 3.1;
  for (const auto& row : table.rows) {
    const double tension = std::stod(row.at("T"));
    BOOST_TEST(tension < last);
    last = tension;
    if (row.at("type") == "contact") BOOST_TEST(row.at("label") == "E" + std::to_string(++events));
  }
  BOOST_TEST(events >= 4);  // above T = 2 three
  // Any point of either part is one to go on from.
  for (const std::string label : {"E1", "1-5", "E4"}) {
    const Outcome on = run_program({"continue", "run", label, "--set", "continuation.to=1.7", "--out",
                                    "on-" + label, "--quiet", "--no-eigenvalues", "--force"},
                                   folder.path());
    BOOST_TEST(on.status == 0, on.err);
  }
}

BOOST_AUTO_TEST_CASE(another_thickness) {
  // Followed in the radius it keeps two of its own radii off itself at every point, and arrives at the state found from nothing.
  const TemporaryFolder folder;
  std::vector<std::string> command = tied("continue", 0.285714,
                                          {"load.tension=1", "continuation.parameter=rod.radius",
                                           "continuation.from=0.285714", "continuation.to=0.5"});
  command.insert(command.end(), {"--out", "run", "--quiet", "--no-eigenvalues"});
  const Outcome outcome = run_program(command, folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err == "");
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
  BOOST_TEST(certificate.err == "");
  const double followed = std::stod(read_csv(folder.path() / "run" / "branches.csv").rows.back().at("R_tot"));
  BOOST_TEST(std::abs(followed / solved(0.5, 1.0)["R_tot"].get<double>() - 1.0) < 1e-8);
}

BOOST_AUTO_TEST_CASE(touches_of_a_line_are_named) {
  // At T = 2 the tails touch twice with a line between, each of them the middle strand once.
  std::map<std::string, int> kinds;
  const nlohmann::json state = solved(0.285714, 2.0);
  double self = 0.0;
  for (const auto& touch : state["contact"]["self"]) {
    ++kinds[touch["kind"]];
    self += touch["force"].get<double>();
    BOOST_TEST(touch["force"].get<double>() > 0.0);
  }
  BOOST_TEST(kinds["touch"] == 4);
  BOOST_TEST(kinds["line"] >= 2);
  BOOST_TEST(std::abs(self - state["self_force"].get<double>()) < 1e-9 * self);
}

BOOST_AUTO_TEST_CASE(materials_in_newtons) {
  // All are stable hitches; that on the plastic cylinder is the dimensionless one of its R/r, rod length and tension. Its EA is
  // 4/r² in these units, the default of a rod with a radius.
  for (const char* name : {"clove-hitch-vps-vps", "clove-hitch-vps-inext", "clove-hitch-vps-pom",
                           "clove-hitch-rope-rope", "clove-hitch-nitinol-steel"}) {
    const Outcome outcome = run_program({"solve", shipped_scene(name), "--json"});
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, name << outcome.err);
    const nlohmann::json state = nlohmann::json::parse(outcome.out), newtons = state["physical"];
    BOOST_TEST(state["stability"]["index"] == 0);
    BOOST_TEST(state["contact"]["self"].size() >= 3U);
    if (std::string(name) != "clove-hitch-vps-pom") continue;
    const double force = newtons["scales"]["force"]["value"], length = newtons["scales"]["length"]["value"],
                 R_tot = newtons["R_tot"]["value"];
    BOOST_TEST(length == 14.0, boost::test_tools::tolerance(1e-14));
    const nlohmann::json plain =
        solved(4.0 / 14.0, state["parameters"]["T"],
               {"rod.length=" + std::to_string(500.0 / 14.0), "rod.extensible=true"});
    // Settings are written with six decimals.
    BOOST_TEST(plain["R_tot"].get<double>() * force == R_tot, boost::test_tools::tolerance(1e-5));
    BOOST_TEST(newtons["F0"]["value"].get<double>() == 0.32 * R_tot, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(friction_is_fitted_on_a_knot) {
  const TemporaryFolder folder;
  const std::string scene = shipped_scene("clove-hitch-vps-pom");
  const Outcome branch = run_program({"continue", scene, "--set", "continuation.from=180 g", "--set",
                                      "continuation.to=90 g", "--out", "run", "--quiet"},
                                     folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  constexpr double mu = 0.27;
  std::ostringstream data;
  data.precision(12);
  data << "T [g], F0 [N]\n";
  for (const int grams : {100, 130, 170}) {  // each from nothing
    const Outcome outcome =
        run_program({"solve", scene, "--json", "--set", "load.tension=" + std::to_string(grams) + " g"});
    const auto state = nlohmann::json::parse(outcome.out);
    data << grams << ", " << mu * state["physical"]["R_tot"]["value"].get<double>() << "\n";
  }
  const auto fit = fit_of(folder, data.str());
  BOOST_TEST(fit["mu"].get<double>() == mu, boost::test_tools::tolerance(1e-7));
  BOOST_TEST(fit["points"].size() == 3U);
  for (const auto& point : fit["points"]) BOOST_TEST(point["R_tot_from"] == "computed");
}

BOOST_AUTO_TEST_CASE(half_and_full_chain_agree) {
  const double half = solved(0.285714, 1.0)["R_tot"],
               full = solved(0.285714, 1.0, {"model.symmetry=none"})["R_tot"];
  BOOST_TEST(std::abs(half - full) < 1e-9 * half);
}

BOOST_AUTO_TEST_CASE(the_way_there_and_back) {
  // Upward the middle of the tails comes to touch, then along a line; downward the same events.
  const TemporaryFolder folder;
  std::vector<double> events[2];
  for (const bool up : {false, true}) {
    std::vector<std::string> command = tied("continue", 0.285714,
                                            {up ? "continuation.from=1.7" : "continuation.from=2",
                                             up ? "continuation.to=2" : "continuation.to=1.7"});
    command.insert(command.end(), {"--out", up ? "up" : "down", "--quiet", "--no-eigenvalues"});
    BOOST_TEST(run_program(command, folder.path()).status == 0);
    for (const auto& row : read_csv(folder.path() / (up ? "up" : "down") / "branches.csv").rows)
      if (row.at("type") == "contact") events[up].push_back(std::stod(row.at("T")));
    std::sort(events[up].begin(), events[up].end());
  }
  BOOST_REQUIRE(events[0].size() == 2U);
  BOOST_REQUIRE(events[1].size() == 2U);
  for (int k : {0, 1}) BOOST_TEST(std::abs(events[0][k] - events[1][k]) < 1e-7);
}

BOOST_AUTO_TEST_CASE(tails_that_press_on_a_line_of_the_middle_strand) {
  // Through the event where one tail comes to press on a line of the other with the middle strand: a point force of that line, at the same
  // place. All states pass, the certificate of H to 1e-9 among them (4e-9 with that force between two touches), and are stable:
  // strands may slide along each other (a count with both held has negative directions).
  const TemporaryFolder folder;
  std::vector<std::string> command =
      tied("continue", 0.285714, {"continuation.from=3.45", "continuation.to=3.55"});
  command.insert(command.end(), {"--out", "run", "--quiet"});
  BOOST_TEST(run_program(command, folder.path()).status == 0);
  BOOST_TEST(run_program({"verify", "run", "--quiet"}, folder.path()).status == 0);
  const auto rows = read_csv(folder.path() / "run" / "branches.csv").rows;
  BOOST_REQUIRE(rows.size() > 3U);
  for (const auto& row : rows) {
    BOOST_TEST(row.at("index") == "0");
    BOOST_TEST(std::stod(row.at("eigenvalue_1")) > 0.0);
  }
}

BOOST_AUTO_TEST_CASE(an_edge_on_one_half_of_a_line_and_another_line_on_the_other) {
  // R/r = 1: the line of a tail with its own image has the edge of the cylinder's contact on one half, and on the other the end of the tail's line with
  // the middle strand. That end presses where the line has a touch (H was off by up to 9.6e-8), both lines share theirs, and
  // the edge moves past none (arcs had their ends the wrong way round).
  const TemporaryFolder folder;
  std::vector<std::string> command =
      tied("continue", 0.5, {"continuation.from=2.47", "continuation.to=2.49"});
  command.insert(command.end(), {"--out", "run", "--quiet", "--no-eigenvalues"});
  BOOST_TEST(run_program(command, folder.path()).status == 0);
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
  for (const auto& row : read_csv(folder.path() / "run" / "branches.csv").rows)
    BOOST_TEST(row.at("index") == "0");
}

BOOST_AUTO_TEST_CASE(a_curve_of_ones_own) {
  // The clove hitch's own curve, from a file, is the clove hitch.
  const TemporaryFolder folder;
  constexpr double radius = 0.285714;
  const auto half = windlass::knot::clove_hitch(radius);
  const auto write = [&](const char* name, double shift) {
    std::ofstream file(folder.path() / name);
    file << "x,y,z\n";
    for (std::size_t k = half.size(); k-- > 1;)
      file << -half[k](0) << ',' << half[k](1) + shift << ',' << -half[k](2) << '\n';
    for (const auto& r : half) file << r(0) << ',' << r(1) << ',' << r(2) << '\n';
  };
  write("hitch.csv", 0.0);
  write("askew.csv", 0.3);
  const auto run = [&](const std::string& file) {
    return run_program(tied("solve", radius, {"load.tension=1", "knot.kind=none", "knot.curve=" + file}),
                       folder.path());
  };
  const Outcome own = run((folder.path() / "hitch.csv").string());
  BOOST_TEST(own.status == 0, own.err);
  BOOST_TEST(own.out.find("R_tot        7.977") != std::string::npos, own.out);
  const Outcome askew = run((folder.path() / "askew.csv").string());
  BOOST_TEST(askew.status == 1);
  BOOST_TEST(askew.err.find("half-turn") != std::string::npos, askew.err);
  BOOST_TEST(run("missing.csv").status == 1);
  for (const char* setting : {"load.angle=3 pi", "rod.self_contact=false", "ends.kind=clamped"}) {
    const Outcome refused = run_program(tied("solve", radius, {setting}), folder.path());
    BOOST_TEST(refused.status == 1, setting);
  }
}

BOOST_AUTO_TEST_CASE(overhand_knot_round_nothing_is_that_of_the_asymptotics) {
  // Loose knots: a loop of the radius R = √(B/2T), so E → π√2 √(BT), and strands that touch along an interval flanked by two
  // touches (Clauvelin, Audoly & Neukirch 2009). Their forces are σ B/R² √(R/r), and energies exceed the loop's by √(r/R) of it.
  constexpr double pull = 0.5;
  std::vector<double> roots, forces, energies;
  for (const double radius : {0.05, 0.1}) {
    const Outcome outcome = run_program(
        {"solve", shipped_scene("overhand-knot"), "--json", "--set", "rod.radius=" + std::to_string(radius)});
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const nlohmann::json state = nlohmann::json::parse(outcome.out);
    BOOST_TEST(state["end_force"].get<double>() == -pull, boost::test_tools::tolerance(1e-12));
    const double loop = 1.0 / std::sqrt(2.0 * pull), root = std::sqrt(radius / loop);
    roots.push_back(root);
    forces.push_back(state["self_force"].get<double>() * loop * loop * root);
    energies.push_back(state["energy"].get<double>() * loop / M_PI);
    BOOST_TEST(state["self_distance"].get<double>() == 2.0 * radius, boost::test_tools::tolerance(1e-7));
    // Of half the rod: a touch, the line, the touch's partner. Ends of the line are touches, too.
    std::map<std::string, int> kinds;
    for (const auto& touch : state["contact"]["self"]) ++kinds[touch["kind"]];
    BOOST_TEST(kinds["touch"] > 0);
    BOOST_TEST(kinds["line"] > 2);
  }
  const auto limit = [&](const std::vector<double>& v) {  // linear in √(r/R)
    return v[0] - roots[0] * (v[1] - v[0]) / (roots[1] - roots[0]);
  };
  BOOST_TEST(limit(energies) == 1.0, boost::test_tools::tolerance(2e-3));
  BOOST_TEST(limit(forces) == 0.49, boost::test_tools::tolerance(0.03));
}

BOOST_AUTO_TEST_CASE(overhand_knot_is_tightened_and_certified) {
  // Its virial is that of the forces of its strands alone: 2r Σ F = H L − E − [n·r].
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"continue", shipped_scene("overhand-knot"), "--set", "rod.radius=0.2", "--set",
                   "continuation.to=-0.55", "--out", "run", "--quiet", "--no-eigenvalues"},
                  folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  const Table table = read_csv(folder.path() / "run" / "branches.csv");
  // The pull is an equation of the last joint's, solved to rounding.
  BOOST_TEST(std::stod(table.rows.back().at("end_force")) == -0.55, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(std::stod(table.rows.back().at("shortening")) < std::stod(table.rows.front().at("shortening")));
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  // Touches inside a line hold the rod a little along itself, which H knows of: all else holds.
  std::istringstream lines(certificate.out);
  int others = 0;
  for (std::string line; std::getline(lines, line);)
    others += contains(line, "FAILED") && !contains(line, "hamiltonian_drift");
  BOOST_TEST(others == 0, certificate.out);
  BOOST_TEST(contains(certificate.out, "integrated again"), certificate.out);
}

BOOST_AUTO_TEST_CASE(a_round_turn_is_the_coil) {
  const TemporaryFolder folder;
  std::ofstream file(folder.path() / "turns.csv");
  file << "-2,-1.02,-0.47\n";
  for (int k = -80; k <= 80; ++k) {
    const double a = 2.0 * M_PI * k / 80.0;
    file << 1.02 * std::sin(a) << ',' << -1.02 * std::cos(a) << ',' << 0.46 * k / 80.0 << '\n';
  }
  file << "2,-1.02,0.47\n";
  file.close();
  const auto force = [&](const std::vector<std::string>& knot) {
    std::vector<std::string> command = {"solve", shipped_scene("half-knot"), "--json", "--set",
                                        "load.tension=1"};
    for (const std::string& setting : knot) command.insert(command.end(), {"--set", setting});
    const Outcome outcome = run_program(command, folder.path());
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return nlohmann::json::parse(outcome.out)["R_tot"].get<double>();
  };
  BOOST_TEST(force({"knot.curve=turns.csv"}) == force({"knot.curve="}), boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(half_knot_is_tightened) {
  const TemporaryFolder folder;
  const Table table =
      certified_run({"continue", shipped_scene("half-knot"), "--set", "continuation.to=1"}, folder);
  for (const auto& row : table.rows) BOOST_TEST(contains(row.at("topology"), "cross"));  // it stays tied
  BOOST_TEST(std::stod(table.rows.back().at("T")) == 1.0);
}

BOOST_AUTO_TEST_CASE(curves_that_no_knot_starts_on) {
  const TemporaryFolder folder;
  const auto says = [&](const std::string& points, const std::string& scene, const char* part) {
    folder.write("curve.csv", points);
    const Outcome outcome = run_program(
        {"solve", shipped_scene(scene), "--set", "knot.kind=none", "--set", "knot.curve=curve.csv"},
        folder.path());
    BOOST_TEST(outcome.status != 0);
    BOOST_TEST(contains(outcome.err, part), outcome.err);
  };
  says("x,y,z\n-1,0,0\n0,0,0\n1,0,0\n", "overhand-knot", "has 3 points; must have 9 or more");
  says("x,y,z\n0,0,0\n1,0\n", "overhand-knot", "curve.csv:3: must be three numbers x, y, z");
  const std::string loop =
      slurp(std::filesystem::path(shipped_scene("overhand-knot")).replace_extension("csv"));
  says(loop + "4,0.6,0.4\n5,0.6,0.4\n", "overhand-knot", "half-turn");
  says(loop, "clove-hitch", "passes through the cylinder");
  const auto run = [&](const std::vector<std::string>& settings, const char* scene = "overhand-knot") {
    std::vector<std::string> command = {"solve", shipped_scene(scene)};
    for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
    return run_program(command, folder.path());
  };
  for (const auto& [settings, part] :
       {std::pair<std::vector<std::string>, const char*>{{"rod.length=3"}, "rod.length"},
        {{"rod.radius=0.6"}, "penetrates itself"},
        {{"load.thrust=0.5"}, "must be < 0"},
        {{"ends.kind=clamped"}, "must be \"moment_free\""},
        {{"rod.self_contact=false"}, "keeps off itself"},
        {{"knot.kind=clove_hitch", "knot.curve="}, "needs a [cylinder]"}}) {
    const Outcome refused = run(settings);
    BOOST_TEST(refused.status == 1);
    BOOST_TEST(contains(refused.err, part), refused.err);
  }
}

BOOST_AUTO_TEST_CASE(a_curve_that_is_no_knot_is_drawn_straight) {
  // A bow, which touches nothing.
  const TemporaryFolder folder;
  std::ostringstream points;
  points << "x,y,z\n";
  for (int k = -40; k <= 40; ++k) {
    const double x = 0.1 * k, bow = std::exp(-x * x);
    points << x << ',' << bow << ',' << 0.3 * x * bow << '\n';
  }
  folder.write("bow.csv", points.str());
  const Outcome outcome =
      run_program({"solve", shipped_scene("overhand-knot"), "--set", "knot.curve=bow.csv"}, folder.path());
  BOOST_TEST(outcome.status != 0);
  BOOST_TEST(contains(outcome.err, "no equilibrium of the knot was found: its pulls draw the rod straight"),
             outcome.err);
}

BOOST_AUTO_TEST_CASE(a_knot_that_falls_open_says_where) {
  // Under a tension for which its tails are too short the hitch opens where a contact reaches its end: what was reached is told.
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"solve", shipped_scene("clove-hitch"), "--set", "rod.radius=0.5",
                                       "--set", "rod.length=37.5", "--set", "load.tension=0.05"},
                                      folder.path());
  BOOST_TEST(outcome.status != 0);
  BOOST_TEST(contains(outcome.err, "the branch ends at 0.08389"), outcome.err);
}

BOOST_AUTO_TEST_CASE(a_slender_rod_stays_tied_while_it_is_relaxed) {
  // Less thick than a step of the descent is long, it must not pass through itself: strands press on each other in the state found.
  const Outcome outcome = run_program({"solve", shipped_scene("clove-hitch-nitinol-steel"), "--json", "--set",
                                       "rod.radius=0.15 mm", "--set", "load.tension=30 g"});
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const nlohmann::json state = nlohmann::json::parse(outcome.out);
  BOOST_TEST(state["contact"]["self"].size() == 3U);
  BOOST_TEST(state["self_force"].get<double>() > 0.1);
}

BOOST_AUTO_TEST_SUITE_END()
