// Struts as a user meets them: nothing undetermined is refused, and the double branch point is reported as one.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "support/csv.hpp"
#include "support/run_program.hpp"

using namespace windlass::test;
using nlohmann::json;

BOOST_AUTO_TEST_SUITE(strut_runs)

BOOST_AUTO_TEST_CASE(the_shipped_strut_is_straight_before_it_is_pushed) {
  for (const char* name : {"strut-clamped", "strut-twisted"}) {
    const TemporaryFolder folder;
    const Outcome outcome = run_program({"solve", shipped_scene(name), "--json"}, folder.path());
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const json answer = json::parse(outcome.out);
    BOOST_TEST(std::abs(answer["end_force"].get<double>()) < 1e-12);
    BOOST_TEST(std::abs(answer["shortening"].get<double>()) < 1e-12);
    BOOST_TEST(answer["stability"]["index"] == 0);
    BOOST_TEST(answer["model_reason"].get<std::string>().find("buckling load") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(buckling_of_an_isotropic_strut_is_a_double_branch_point_with_one_arm) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"diagram", shipped_scene("strut-thrust"), "--set", "continuation.to=50", "--out", "run"},
                  folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json specials = json::parse(slurp(folder.path() / "run" / "special_points.json"));
  BOOST_TEST_REQUIRE(specials.size() >= 1u);
  BOOST_TEST(specials[0]["type"] == "branch_point");
  BOOST_TEST(specials[0]["multiplicity"] == 2);
  BOOST_TEST(specials[0]["mode"]["parity"] == "even");  // the one the half chain follows
  BOOST_TEST(specials[0]["precision"].get<double>() < 1e-7);
  const std::string csv = slurp(folder.path() / "run" / "branches.csv");
  BOOST_TEST(csv.find(",B1,branch_point,") != std::string::npos);
  BOOST_TEST(csv.find("\n2,1,") != std::string::npos);  // the arm
  BOOST_TEST(csv.find("\n3,1,") == std::string::npos);  // and only one
  BOOST_TEST(run_program({"verify", "run"}, folder.path()).status == 0);
}

// In the plane a half strut turns about the line of its ends at no cost while it is held at both of its own: the arc is
// singular by itself on the whole branch, and its elimination must not lose digits for that.
BOOST_AUTO_TEST_CASE(the_loss_out_of_the_plane_is_where_its_precision_says) {
  double first = 0.0, printed = 0.0;
  for (const char* tolerance : {"1e-9", "1e-10", "1e-11", "1e-12"}) {
    const TemporaryFolder folder;
    const Outcome outcome =
        run_program({"diagram", shipped_scene("strut-clamped"), "--set",
                     "model.tolerance=" + std::string(tolerance), "--no-eigenvalues", "--out", "run"},
                    folder.path());
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const json loss = json::parse(slurp(folder.path() / "run" / "special_points.json"))[0];
    const double at = loss["parameter"], precision = loss["precision"];
    BOOST_TEST(std::abs(at - 0.542673) < 1e-6);  // finite-difference rod, six digits
    BOOST_TEST(precision < 1e-10);
    // Twelve digits, and 3e-12 of rounding that one run cannot see.
    if (first > 0.0) BOOST_TEST(std::abs(at - first) < printed + precision + 1e-11);
    if (first == 0.0) first = at, printed = precision;
  }
}

// Pushed to nearly twice its length the strut is a small loop whose way along the rod costs exp(-33) of the rest: less than
// rounding. Its sign is no branch point.
BOOST_AUTO_TEST_CASE(rounding_makes_no_branch_points_in_a_long_loop) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"diagram", shipped_scene("strut-clamped"), "--set",
                                       "continuation.to=1.95", "--no-eigenvalues", "--out", "run"},
                                      folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json specials = json::parse(slurp(folder.path() / "run" / "special_points.json"));
  BOOST_TEST_REQUIRE(specials.size() == 2u);  // the loss out of the plane, and the ends that meet
  BOOST_TEST(std::abs(specials[1]["parameter"].get<double>() - 1.0) < 1e-9);
}

BOOST_AUTO_TEST_CASE(michells_ring_buckles_in_two_modes_at_once) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"continue", shipped_scene("ring-michell"), "--out", "run"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json specials = json::parse(slurp(folder.path() / "run" / "special_points.json"));
  BOOST_TEST_REQUIRE(specials.size() == 1u);
  BOOST_TEST(specials[0]["multiplicity"] == 2);  // cos 2θ and sin 2θ
}

BOOST_AUTO_TEST_CASE(a_parameter_that_makes_new_arcs_is_followed) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"continue", shipped_scene("strut-clamped"), "--set", "ends.shortening=0.3", "--set",
                   "continuation.parameter=rod.twist_ratio", "--set", "continuation.from=0.5", "--set",
                   "continuation.to=1", "--out", "run"},
                  folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  // The strut stays in its plane and does not twist: its force knows nothing of the twisting stiffness.
  const Table table = read_csv(folder.path() / "run" / "branches.csv");
  BOOST_REQUIRE(table.rows.size() > 1u);
  const double first = std::stod(table.rows.front().at("end_force"));
  const double last = std::stod(table.rows.back().at("end_force"));
  BOOST_TEST(std::abs(last - first) < 1e-8 * std::abs(first));  // the scene's tolerance
}

BOOST_AUTO_TEST_SUITE_END()
