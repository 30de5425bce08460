// Measured strengths through the program: fitted, laid over a diagram, refused.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;

namespace {

constexpr double mu = 0.27, two_pi = 2.0 * M_PI;

/// A material scene: ρ = 14 mm, EI/ρ² = 1.231 N.
std::string scene() { return shipped_scene("capstan-vps-pom"); }

void make_measured_run(const TemporaryFolder& folder) {
  const Outcome outcome =
      run_program({"diagram", scene(), "--set", "rod.length=400 mm", "--set", "continuation.to=60 g", "--set",
                   "rod.self_contact=false", "--set", "rod.extensible=false", "--out", "run",
                   "--quiet"},  // the closed form is that of a thin rod that does not stretch
                  folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
}

/// Strengths in newtons against grams hung, F0 = mu R_tot of the closed form, at tensions where the flat coil is stable.
std::string flat_strengths(double unit_force) {
  std::ostringstream text;
  text.precision(12);
  text << "# made, not measured\nT [g], F0 [N]\n";
  for (double T = 1.5; T < 7.0; T *= 1.3)
    text << T * unit_force / 9.80665e-3 << ", " << mu * capstan::total_force(T, two_pi) * unit_force << "\n";
  return text.str();
}

double unit_force() {
  const Outcome outcome = run_program({"solve", scene(), "--set", "model.kind=planar", "--json"});
  return nlohmann::json::parse(outcome.out)["physical"]["scales"]["force"]["value"].get<double>();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(measurement)

BOOST_AUTO_TEST_CASE(a_known_coefficient_is_found_again) {
  const TemporaryFolder folder;
  make_measured_run(folder);
  folder.write("data.csv", flat_strengths(unit_force()));
  const Outcome outcome =
      run_program({"fit", "run", "--csv", "data.csv", "--json", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto fit = nlohmann::json::parse(outcome.out);
  // Tails of 10 ρ and more: the finite length changes R_tot by exp(-2 √1.5 10) < 1e-10; the tolerance of the run is 1e-8.
  BOOST_TEST(std::abs(fit["mu"].get<double>() / mu - 1.0) < 1e-7);
  BOOST_TEST(fit["standard_error"].get<double>() < 1e-7);
  BOOST_TEST(fit["points"].size() == 6u);
  const double begins = 0.6 * 9.80665 / unit_force();  // 600 g
  for (const auto& point : fit["points"])
    BOOST_TEST(point["R_tot_from"] == (point["T"].get<double>() > begins ? "above_run" : "computed"));
  BOOST_TEST(std::filesystem::exists(folder.path() / "run/fit/fit.png"));

  // Below the loss of stability of the flat coil the force is the helix's, not the closed form's.
  folder.write("low.csv", "T, F0\n1, " + std::to_string(mu * capstan::total_force(1.0, two_pi)) + "\n3, " +
                              std::to_string(mu * capstan::total_force(3.0, two_pi)) + "\n");
  const Outcome low =
      run_program({"fit", "run", "--csv", "low.csv", "--json", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(low.status == 0, low.err);
  const auto points = nlohmann::json::parse(low.out)["points"];
  BOOST_TEST(points[0]["R_tot"].get<double>() > 1.1 * capstan::total_force(1.0, two_pi));
  BOOST_TEST(points[1]["R_tot"].get<double>() == capstan::total_force(3.0, two_pi),
             boost::test_tools::tolerance(1e-7));
  const Outcome high = run_program(
      {"fit", "run", "--csv", "low.csv", "--json", "--min-tension", "2 N", "--format", "png"}, folder.path());
  BOOST_TEST(high.status == 1);
  BOOST_TEST(contains(high.err, "at least two measured points; there are 1"), high.err);
}

BOOST_AUTO_TEST_CASE(a_full_disk_does_not_take_the_numbers) {
  const TemporaryFolder folder;
  make_measured_run(folder);
  folder.write("data.csv", flat_strengths(unit_force()));
  // Room for what is printed, 1 kB, not for the picture.
  const Outcome outcome =
      run_program({"fit", "run", "--csv", "data.csv"}, folder.path(), "eval \"trap '' XFSZ; ulimit -f 6\";");
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(contains(outcome.out, "mu = 0.27"), outcome.out);
  BOOST_TEST(contains(outcome.err, "windlass: cannot write run/fit/fit"), outcome.err);
}

BOOST_AUTO_TEST_CASE(measured_points_are_laid_over_the_diagram) {
  const TemporaryFolder folder;
  make_measured_run(folder);
  folder.write("data.csv", "T, F0\n1.6, 1.8\n3.2, 4.1\n");
  const Outcome outcome =
      run_program({"plot", "run", "--csv", "data.csv", "--format", "svg", "--set", "cylinder.friction=0.5"},
                  folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  BOOST_TEST(contains(slurp(folder.path() / "run/plots/diagram-measured.dat"), "1.6 3.6\n3.2 8.2\n"));
  BOOST_TEST(contains(slurp(folder.path() / "run/plots/diagram.svg"), "measured"));
}

BOOST_AUTO_TEST_CASE(bad_measurements_are_named) {
  const TemporaryFolder folder;
  make_measured_run(folder);
  folder.write("bad.csv", "T [g], F0 [N]\n100, 1\n200, 1..9\n");
  for (const char* command : {"fit", "plot"}) {
    const Outcome outcome = run_program({command, "run", "--csv", "bad.csv"}, folder.path());
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST(outcome.err == "windlass: bad.csv:3: column 2: \"1..9\": F0 must be a number\n");
  }
  const Outcome missing = run_program({"fit", "run", "--csv", "none.csv"}, folder.path());
  BOOST_TEST(missing.status == 1);
  BOOST_TEST(contains(missing.err, "none.csv"), missing.err);
}

BOOST_AUTO_TEST_CASE(solve_prints_units_beside_dimensionless_numbers) {
  const Outcome outcome = run_program({"solve", scene(), "--set", "model.kind=planar"});
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  for (const char* part : {"130 g hung", "1.27486 N", " N/mm", " mm", "360°", "F0  "})
    BOOST_TEST(contains(outcome.out, part), outcome.out);
}

BOOST_AUTO_TEST_SUITE_END()
