// Dragged rods that are their own mirror images, on half a chain, as a user has them computed.

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;

namespace {

std::vector<std::string> command_of(const std::string& command, const std::vector<std::string>& settings) {
  std::vector<std::string> out = {command, shipped_scene("capstan-2pi-plate")};
  for (const std::string& setting : settings) out.insert(out.end(), {"--set", setting});
  return out;
}

nlohmann::json solved(const std::vector<std::string>& settings) {
  std::vector<std::string> command = command_of("solve", settings);
  command.push_back("--json");
  const TemporaryFolder folder;
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

/// A run all of whose points pass their certificates; its special points.
nlohmann::json walked(const std::string& command, const std::string& run,
                      const std::vector<std::string>& settings) {
  std::vector<std::string> words = command_of(command, settings);
  words.insert(words.end(), {"--out", run, "--quiet"});
  const TemporaryFolder folder;
  const Outcome outcome = run_program(words, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status != 1, outcome.err);  // 2: beyond what is looked at a branch is lost
  const Outcome verified = run_program({"verify", run}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
  return nlohmann::json::parse(std::ifstream(run + "/special_points.json"));
}

/// A coil that hangs from the plate on both sides.
std::vector<std::string> arch(std::vector<std::string> more) {
  more.insert(more.begin(), {"load.angle=3 pi", "model.symmetry=mirror", "model.kind=kirchhoff"});
  return more;
}

double relative(const nlohmann::json& a, const nlohmann::json& b) {
  return std::abs(a.get<double>() / b.get<double>() - 1.0);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mirror_images)

BOOST_AUTO_TEST_CASE(half_a_flat_coil_is_the_whole_one) {
  // On a line, on two touches, and on one in the middle. Both are solved on meshes of errors below 1e-11 (`error_estimate`).
  for (const auto& [angle, tension] : {std::pair{"load.angle=2 pi", "load.tension=2"},
                                       {"load.angle=2 pi", "load.tension=0.4"},
                                       {"load.angle=pi", "load.tension=0.45"}}) {
    const nlohmann::json half = solved({angle, tension, "model.symmetry=mirror"}),
                         whole = solved({angle, tension});
    BOOST_TEST(half["model"] == "kirchhoff_half");
    BOOST_TEST(whole["model"] == "kirchhoff_full");
    for (const char* key : {"F0", "R_tot", "energy"}) BOOST_TEST(relative(half[key], whole[key]) < 1e-9, key);
    BOOST_TEST(half["contact"]["topology"] == whole["contact"]["topology"]);
    BOOST_TEST(half["contact"]["joints"].size() == whole["contact"]["joints"].size());
    BOOST_TEST(half["stability"]["index"] == whole["stability"]["index"]);
    // Judged on the whole rod: odd motions, too.
    const auto &a = half["stability"]["leading"], &b = whole["stability"]["leading"];
    BOOST_REQUIRE(std::min(a.size(), b.size()) >= 2u);  // as many as converge
    for (std::size_t k = 0; k < 2; ++k)
      BOOST_TEST(std::abs(a[k][0].get<double>() - b[k][0].get<double>()) < 1e-9);
    BOOST_TEST(half["travel"]["pull_difference"] == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(coils_hang_from_the_plate_on_both_sides) {
  for (const char* travel : {"ends.travel=blocked", "ends.travel=free"}) {
    const nlohmann::json found =
        solved({"load.angle=3 pi", "load.tension=0.4", "model.symmetry=mirror", travel});
    const auto& states = found["states"];
    const auto hanging = std::find_if(states.begin(), states.end(), [](const nlohmann::json& state) {
      return state["topology"] == "tail touch:2 gap touch gap touch gap touch gap touch:2 tail";
    });
    BOOST_REQUIRE(hanging != states.end());
    // The full chain's, which `pull` polishes from its plateau (regression/pull_test.cpp); there it needs no travel either.
    BOOST_TEST(std::abs((*hanging)["F0"].get<double>() / 0.4304070862784 - 1.0) < 1e-9);
    BOOST_TEST(std::abs((*hanging)["F0"].get<double>() / (0.32 * (*hanging)["R_tot"].get<double>()) - 1.0) <
               1e-9);
    BOOST_TEST((*hanging)["index"] == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_hanging_coil_is_followed_through_its_contacts_and_a_fold) {
  const TemporaryFolder folder;
  const std::string run = (folder / "run").string();
  const auto points = walked("continue", run, arch({"continuation.from=0.4", "continuation.to=0.55"}));
  // The full chain's contacts and fold, followed without the symmetry: what is printed of them.
  const std::vector<std::pair<const char*, double>> expected = {
      {"contact", 0.44774130}, {"contact", 0.50665248}, {"fold", 0.51423646}, {"contact", 0.50899273}};
  BOOST_REQUIRE(points.size() >= expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    BOOST_TEST(points[k]["type"] == expected[k].first);
    BOOST_TEST(std::abs(points[k]["parameter"].get<double>() - expected[k].second) <
               1e-8 + points[k]["precision"].get<double>());
  }
}

BOOST_AUTO_TEST_CASE(one_handed_states_leave_a_hanging_coil) {
  const TemporaryFolder folder;
  const std::string run = (folder / "run").string();
  const auto points =
      walked("diagram", run,
             arch({"load.tension=0.3", "rod.length=40", "continuation.parameter=load.angle",
                   "continuation.from=3 pi", "continuation.to=6.8", "continuation.max_points=25"}));
  const auto leaves = std::find_if(points.begin(), points.end(), [](const nlohmann::json& point) {
    return point["type"] == "branch_point";
  });
  BOOST_REQUIRE(leaves != points.end());
  BOOST_TEST((*leaves)["mode"]["parity"] == "odd");
  BOOST_TEST((*leaves)["precision"].get<double>() < 1e-8);
  // Found by signs of determinants; the eigenvalues are of another matrix, by another library.
  const Table table = read_csv(std::filesystem::path(run) / "branches.csv");
  int here = 0, beside = 0;
  const double at = (*leaves)["parameter"];
  for (const auto& row : table.rows) {
    if (row.at("branch") != "1") {
      ++beside;
      continue;
    }
    if (row.at("type") == "branch_point") {
      BOOST_TEST(std::abs(std::stod(row.at("eigenvalue_1"))) < 1e-8);
      ++here;
    }
    if (row.at("type") == "regular")
      BOOST_TEST(row.at("index") == (std::stod(row.at("phi")) > at ? "0" : "1"));
  }
  BOOST_TEST(here == 1);
  BOOST_TEST(beside > 5);  // its arm, on the full chain
}

BOOST_AUTO_TEST_CASE(a_mirror_that_is_none_is_refused) {
  const TemporaryFolder folder;
  for (const auto& [setting, why] : {std::pair{"cylinder.sliding=none", "without cylinder.sliding"},
                                     {"ends.left=clamped", "held differently"},
                                     {"model.kind=planar", "with model.kind"}}) {
    const Outcome outcome =
        run_program(command_of("solve", {"model.symmetry=mirror", setting}), folder.path());
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST(outcome.err.find("model.symmetry") != std::string::npos, outcome.err);
    BOOST_TEST(outcome.err.find(why) != std::string::npos, outcome.err);
  }
  std::vector<std::string> thick = {"solve", shipped_scene("capstan-2pi-plate-thick"), "--set",
                                    "model.symmetry=mirror"};
  const Outcome outcome = run_program(thick, folder.path());
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(outcome.err.find("may touch itself") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
