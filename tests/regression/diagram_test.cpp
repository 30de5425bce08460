// Whole diagrams of long coils, as a user runs them: no branch is lost, every point passes its certificate.

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/certified_run.hpp"
#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

/// Runs a command, then `verify`; the run is in `folder`/run.
void draw(const TemporaryFolder& folder, const std::string& name, const std::vector<std::string>& settings,
          const std::string& command = "diagram") {
  std::vector<std::string> words = {command, shipped_scene(name)};
  for (const std::string& setting : settings) {
    words.push_back("--set");
    words.push_back(setting);
  }
  certified_run(words, folder);
}

Table rows_of(const TemporaryFolder& folder) { return read_csv(folder.path() / "run" / "branches.csv"); }

double number(const std::map<std::string, std::string>& row, const char* column) {
  return std::stod(row.at(column));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(diagrams)

// Below T = 1/2 a flat coil on two touches turns at no cost where phi is a multiple of pi. It must not turn by rounding:
// z_span is that of rounding, and the index, the number of helical arms that have left, stays what it was.
BOOST_AUTO_TEST_CASE(a_flat_coil_stays_flat_where_a_turn_costs_nothing) {
  for (const char* angle : {"3 pi", "5 pi"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi", {"load.angle=\"" + std::string(angle) + "\"", "continuation.to=0.2"});
    int low = 0, index = -1;
    for (const auto& row : rows_of(folder).rows) {
      if (row.at("branch") != "1" || row.at("type") != "regular" || number(row, "T") >= 0.5) continue;
      ++low;
      BOOST_TEST(number(row, "z_span") < 1e-10);
      if (index < 0) index = std::stoi(row.at("index"));
      BOOST_TEST(std::stoi(row.at("index")) == index, angle << ", T = " << row.at("T"));
    }
    BOOST_TEST(low > 5);
    BOOST_TEST(index > 0);
  }
}

// Long helices pass states that are singular for other reasons than a branch: modes soft only while the rod is held against
// sliding (5 pi), touches that carry nothing, and tails that end just behind the last contact (6 pi).
BOOST_AUTO_TEST_CASE(long_coils_are_complete) {
  for (const int turns : {5, 6}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi",
         {"load.angle=\"" + std::to_string(turns) + " pi\"",
          "rod.length=" + std::to_string(turns * M_PI + 22.0)});
    std::map<std::string, double> ends;
    for (const auto& row : rows_of(folder).rows) ends[row.at("branch")] = number(row, "T");
    BOOST_TEST(ends.size() >= 3u);
    // Each goes down to the least tension or, round a fold, back up to the highest.
    for (const auto& [branch, T] : ends)
      BOOST_TEST(std::min(std::abs(T - 0.1), std::abs(T - 5.0)) < 1e-12,
                 "branch " << branch << " ends at " << T);
  }
}

// A pressure that is nearly even pulls weakly on a wide stretch: between the turns of a long coil of low twisting stiffness it
// has two dips, with less than 1e-5 between them, in several places at once.
BOOST_AUTO_TEST_CASE(weak_dips_of_the_pressure_open_together) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi",
       {"load.angle=\"6 pi\"", "rod.length=" + std::to_string(6.0 * M_PI + 22.0), "ends.kind=clamped",
        "rod.twist_ratio=0.2"});
  std::map<std::string, double> ends;
  for (const auto& row : rows_of(folder).rows) ends[row.at("branch")] = number(row, "T");
  BOOST_TEST(ends.size() >= 4u);
}

// On a full chain both outermost contacts widen at once, while their mean place is held.
BOOST_AUTO_TEST_CASE(both_outer_contacts_of_a_full_chain_widen_at_once) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi",
       {"load.angle=\"3 pi\"", "rod.length=" + std::to_string(3.0 * M_PI + 60.0), "ends.kind=clamped",
        "rod.twist_ratio=5", "model.symmetry=none"});
}

// Where the outer touches of an arch meet their neighbours, on both sides at once, it goes on with three touches. Long clamped tails
// hardly feel how long they are.
BOOST_AUTO_TEST_CASE(gaps_that_are_mirror_images_close_together) {
  std::vector<double> found;
  for (const char* length : {"35.463", "39.6314"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi",
         {"load.angle=\"3 pi\"", std::string("rod.length=") + length, "ends.kind=clamped",
          "rod.twist_ratio=1", "continuation.to=0.34", "model.symmetry=none"});
    for (const auto& row : rows_of(folder).rows)
      if (row.at("type") == "contact" && row.at("topology") == "tail touch gap touch gap touch tail" &&
          std::abs(number(row, "tilt")) < 1e-8)
        found.push_back(number(row, "T"));
  }
  BOOST_REQUIRE(found.size() == 2u);
  BOOST_TEST(std::abs(found[0] - found[1]) < 1e-6);
}

// On an arm without symmetry the pressure of a line falls to zero close to the line's edge, at more than one place within 1e-4 in
// T: neither gap is taken for a touch that has not been reached.
BOOST_AUTO_TEST_CASE(a_gap_close_to_an_edge_opens_once) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi",
       {"load.angle=\"3 pi\"", "rod.length=39.6314", "ends.kind=clamped",
        "rod.twist_ratio=0.6666666666666666", "continuation.to=0.55", "model.symmetry=none"});
  int events = 0;
  for (const auto& row : rows_of(folder).rows)
    events += row.at("branch") == "4" && row.at("type") == "contact" && number(row, "T") > 0.5745;
  BOOST_TEST(events == 1);
}

// A flat loop on two touches turns about the pulls at no cost. That zero is no branch point, nor does it hide one: with long
// clamped tails, which are as good as free of moment at their ends, and with a branch point close to where the loop begins.
BOOST_AUTO_TEST_CASE(a_turn_that_costs_nothing_is_told_from_branch_points) {
  for (const auto& [length, points] : std::map<double, int>{{22.0, 1}, {60.0, 1}}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi",
         {"load.angle=\"2 pi\"", "rod.length=" + std::to_string(2.0 * M_PI + length), "ends.kind=clamped",
          "rod.twist_ratio=5", "model.symmetry=none"});
    int found = 0;
    for (const auto& row : rows_of(folder).rows)
      found += row.at("branch") == "1" && row.at("type") == "branch_point";
    BOOST_TEST(found == points, "phi + " << length);
  }
}

// A closed branch, between two branch points that it goes through: found once, though its mesh is another each time round.
BOOST_AUTO_TEST_CASE(a_closed_branch_is_gone_round_once) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi",
       {"load.angle=\"4 pi\"", "rod.length=" + std::to_string(4.0 * M_PI + 8.0), "rod.twist_ratio=0.2"});
  BOOST_TEST(rows_of(folder).rows.size() < 1000u);
}

// The helical branch of a short rod joins two branch points of the flat one: it is one branch, followed once, though its
// other end has moved along the axis.
BOOST_AUTO_TEST_CASE(a_branch_that_joins_two_points_of_another_is_found_once) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi",
       {"load.angle=\"1.3 pi\"", "rod.length=" + std::to_string(1.3 * M_PI + 8.0), "ends.kind=clamped",
        "rod.twist_ratio=1", "model.symmetry=none"});
  std::map<std::string, int> branches;
  for (const auto& row : rows_of(folder).rows) ++branches[row.at("branch")];
  BOOST_TEST(branches.size() == 2u);
}

// Unstable flat loops of a short rod grow until their two touches are at its ends: the branch ends there, and says so, before
// the moment in what is left of its tails is all rounding, which a rod stiff in twist makes of more.
BOOST_AUTO_TEST_CASE(a_contact_at_the_rods_end_ends_the_branch) {
  for (const char* twist_ratio : {"0.6666666667", "5"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi",
         {"load.angle=\"2.25 pi\"", "rod.length=" + std::to_string(2.25 * M_PI + 8.0),
          std::string("rod.twist_ratio=") + twist_ratio, "model.symmetry=none"});
    bool said = false;
    for (const auto& special :
         nlohmann::json::parse(std::ifstream(folder.path() / "run" / "special_points.json")))
      said = said || special["after"] == "contact at the rod's end";
    BOOST_TEST(said, twist_ratio);
  }
}

// Whatever mesh the tolerance asks for: the same branches and events, down to what rounding allows.
BOOST_AUTO_TEST_CASE(refining_the_tolerance_loses_no_branch) {
  std::vector<double> first;
  for (const char* tolerance : {"1e-8", "1e-11", "1e-13"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi", {"rod.length=40", "model.tolerance=" + std::string(tolerance)});
    std::vector<double> tensions;
    for (const auto& point : nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json")))
      tensions.push_back(point["T"]);
    if (first.empty()) first = tensions;
    BOOST_TEST_REQUIRE(tensions.size() == first.size(), "tolerance " << tolerance);
    for (std::size_t k = 0; k < first.size(); ++k)
      BOOST_TEST(std::abs(tensions[k] - first[k]) <
                 1e-5);  // events beside short gaps: precisions of 1e-6 and less
  }
}

// The arm of index 2 that leaves the clamped 4 pi coil second goes through a dozen contact topologies.
BOOST_AUTO_TEST_CASE(arms_of_the_clamped_coil_reach_the_least_tension) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"diagram", shipped_scene("capstan-4pi"), "--out", "run", "--quiet",
                                       "--no-eigenvalues", "--set", "ends.kind=\"clamped\""},
                                      folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(run_program({"verify", "run"}, folder.path()).status == 0);
  std::map<std::string, double> least;
  for (const auto& row : rows_of(folder).rows) {
    double& T = least.try_emplace(row.at("branch"), 1e9).first->second;
    T = std::min(T, number(row, "T"));
  }
  BOOST_TEST(least.size() >= 3u);  // the flat one, two even arms
  for (const auto& [branch, T] : least) BOOST_TEST(T == 0.1, boost::test_tools::tolerance(1e-9));
}

// Full chain: even and odd arms, touches at the mid-point that appear, lose their force and flatten, and two secondary
// branches without any symmetry, whose mid-point is held.
BOOST_AUTO_TEST_CASE(a_full_chain_follows_odd_and_asymmetric_arms) {
  const TemporaryFolder folder;
  draw(folder, "capstan-4pi", {"model.symmetry=\"none\""});
  const auto special = nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json"));
  int odd = 0;
  for (const auto& point : special) {
    if (point["type"] != "branch_point") continue;
    BOOST_TEST(point["mode"]["plane"] == "out");
    odd += point["mode"]["parity"] == "odd";
  }
  BOOST_TEST(odd >= 1);
  // Even arms are those of the half chain, to within the error of both.
  const TemporaryFolder half;
  draw(half, "capstan-4pi", {});
  int events = 0, odd_of_half = 0;
  for (const auto& of_half : nlohmann::json::parse(slurp(half.path() / "run" / "special_points.json"))) {
    events += of_half["type"] == "contact";
    if (of_half["type"] == "branch_point" && of_half["mode"]["parity"] == "odd") {
      if (odd_of_half++ == 0) BOOST_TEST(std::abs(of_half["T"].get<double>() - 1.268855241) < 1e-8);
    }
    // On other meshes, so as far apart as the precision of both allows (and no less than what rounding leaves).
    double excess = 1.0;
    for (const auto& point : special) {
      const double allowed = of_half["precision"].get<double>() + point["precision"].get<double>() + 1e-9;
      excess =
          std::min(excess, std::abs(point["T"].get<double>() - of_half["T"].get<double>()) / allowed - 1.0);
    }
    BOOST_TEST(excess <= 0.0, "no special point of the full chain at T = " << of_half["T"]);
  }
  BOOST_TEST(events > 8);
  BOOST_TEST(odd_of_half == odd);  // which the half chain itself cannot follow: arms on the full chain
}

// Drawn on two meshes: what special points have moved by is within the precisions printed.
BOOST_AUTO_TEST_CASE(printed_precisions_hold_what_the_mesh_moves) {
  const auto drawn = [](const char* tolerance) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi", {"model.tolerance=" + std::string(tolerance)});
    return nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json"));
  };
  const nlohmann::json coarse = drawn("1e-5"), fine = drawn("1e-11");
  int folds = 0, branch_points = 0;
  for (const auto& point : coarse) {
    folds += point["type"] == "fold";
    branch_points += point["type"] == "branch_point";
    double excess = HUGE_VAL;
    for (const auto& other : fine) {
      if (other["type"] != point["type"] || other["before"] != point["before"] ||
          other["after"] != point["after"])
        continue;
      const double apart = std::abs(point["T"].get<double>() - other["T"].get<double>());
      excess = std::min(excess, apart - point["precision"].get<double>() - other["precision"].get<double>());
    }
    BOOST_TEST(excess <= 0.0, point["label"] << " of " << point["type"] << " moves");
  }
  BOOST_TEST(folds >= 1);
  BOOST_TEST(branch_points >= 4);
}

// Tails so short that they resist sliding: the half chain's last odd point, at T = 0.1131259258 on the full chain
// (`diagram` of the same with model.symmetry="none"); held against sliding the rod would lose stability at 0.1291656.
BOOST_AUTO_TEST_CASE(an_odd_point_of_a_half_chain_is_that_of_a_rod_free_to_slide) {
  for (const char* step : {"0", "0.1"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-4pi",
         {"load.angle=\"5 pi\"", "rod.length=37.70796326794897", "rod.twist_ratio=0.2",
          std::string("continuation.step_max=") + step});
    double last = 0.0;
    for (const auto& point : nlohmann::json::parse(slurp(folder.path() / "run" / "special_points.json")))
      if (point["type"] == "branch_point" && point["mode"]["parity"] == "odd")
        last = point["T"].get<double>();
    BOOST_TEST(std::abs(last - 0.1131259258) < 1e-9);
  }
}

// phi at fixed T, through the flattening of the one touch, the coil and its helices.
BOOST_AUTO_TEST_CASE(branches_in_the_angle_reach_eight_pi) {
  for (const char* ends : {"moment_free", "clamped"}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-2pi",
         {"continuation.parameter=\"load.angle\"", "load.tension=0.8", "continuation.from=\"0.25 pi\"",
          "continuation.to=\"8 pi\"", "rod.length=60", "ends.kind=\"" + std::string(ends) + "\""});
    double most = 0.0;
    for (const auto& row : rows_of(folder).rows) most = std::max(most, number(row, "phi"));
    BOOST_TEST(most == 8.0 * M_PI, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(the_loss_of_the_last_contact_is_a_point_in_the_plane_of_tension_and_angle) {
  const TemporaryFolder folder;
  draw(folder, "capstan-2pi", {"continuation.from=0.6"});
  const Outcome outcome = run_program({"locus", "run", "E2", "--out", "curve"}, folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err.find("a point, not a curve") != std::string::npos, outcome.err);
  BOOST_TEST(read_csv(folder.path() / "curve" / "branches.csv").rows.size() == 1u);
}

namespace {

nlohmann::json special_points(const std::filesystem::path& run) {
  return nlohmann::json::parse(slurp(run / "special_points.json"));
}

}  // namespace

// Where a gap opens the branch goes on at the event itself: a target a millionth beyond is reached, and from far beyond the
// branch comes back through the same event.
BOOST_AUTO_TEST_CASE(an_opening_gap_is_passed_in_both_directions) {
  const TemporaryFolder folder;
  draw(folder, "capstan-2pi", {"continuation.to=0.45"});
  double opens = 0.0;
  for (const auto& point : special_points(folder.path() / "run"))
    if (point["branch"] == 2 && point["type"] == "contact") opens = point["T"];
  BOOST_TEST(std::abs(opens - 0.5077333) < 1e-7);
  const auto last = rows_of(folder).rows.back();
  BOOST_TEST_REQUIRE(last.at("branch") == "2");
  const std::string label = "2-" + last.at("point");
  for (const double beyond : {-1e-6, 1e-6}) {
    const TemporaryFolder near;
    draw(near, "capstan-2pi", {"continuation.to=" + std::to_string(opens + beyond)});
    double least = 1e9;
    for (const auto& row : rows_of(near).rows)
      if (row.at("branch") == "2") least = std::min(least, number(row, "T"));
    BOOST_TEST(std::abs(least - opens - beyond) < 1e-6);  // as many digits as the target was written with
  }
  const Outcome back = run_program({"continue", "run", label, "--set", "continuation.to=1.2", "--out", "back",
                                    "--quiet", "--no-eigenvalues"},
                                   folder.path());
  BOOST_TEST(back.status == 0, back.err);
  BOOST_TEST(run_program({"verify", "back"}, folder.path()).status == 0);
  const auto passed = special_points(folder.path() / "back");
  BOOST_TEST_REQUIRE(passed.size() == 1u);
  BOOST_TEST(std::abs(passed[0]["T"].get<double>() - opens) < 1e-8);
  BOOST_TEST(passed[0]["after"] == "tail line tail");
}

// The unit of stiffness is the user's: forces scale with it, and nothing else changes, to the last digits.
BOOST_AUTO_TEST_CASE(the_unit_of_stiffness_does_not_matter) {
  std::vector<double> expected;
  for (const double b : {1.0, 1e-4, 1e4}) {
    const TemporaryFolder folder;
    draw(folder, "capstan-2pi",
         {"rod.bending_stiffness=" + std::to_string(b), "load.tension=" + std::to_string(b),
          "continuation.from=" + std::to_string(5.0 * b), "continuation.to=" + std::to_string(0.2 * b)});
    std::vector<double> found;
    for (const auto& point : special_points(folder.path() / "run"))
      found.push_back(point["T"].get<double>() / b);
    if (expected.empty()) expected = found;
    BOOST_TEST(found == expected, boost::test_tools::tolerance(1e-12) << boost::test_tools::per_element());
  }
  BOOST_TEST(expected.size() == 4u);
}

BOOST_AUTO_TEST_SUITE_END()
