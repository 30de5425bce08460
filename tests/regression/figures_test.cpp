// The paper's figures through the program, as a reader gets them.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;

namespace {

/// Rows of one block of a data file for gnuplot, those of missing values left out.
std::vector<std::vector<double>> block(const std::filesystem::path& path, int wanted) {
  std::istringstream text(slurp(path));
  std::vector<std::vector<double>> rows;
  int current = -1;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("# block ")) current = std::stoi(line.substr(8));
    if (line.empty() || line.front() == '#' || line.front() == '?' || current != wanted) continue;
    std::istringstream numbers(line);
    rows.push_back({std::istream_iterator<double>(numbers), {}});
  }
  return rows;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(figures)

BOOST_AUTO_TEST_CASE(every_figure_is_made_with_data_script_and_statements) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"figures", "--out", "figs", "--format", "svg", "--json"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto figs = folder.path() / "figs";
  const std::string page = slurp(figs / "index.html");
  const auto summary = nlohmann::json::parse(outcome.out);
  BOOST_TEST(summary["figures"].size() == 14u);
  for (const std::string stem : summary["figures"]) {
    BOOST_TEST(slurp(figs / (stem + ".svg")).starts_with("<?xml"), stem);
    BOOST_TEST(std::filesystem::exists(figs / (stem + ".gp")), stem);
    BOOST_TEST(contains(page, "<img src=\"" + stem + ".svg\""), stem);
  }
  BOOST_TEST(contains(page, "class=\"agrees\""));
  BOOST_TEST(contains(page, "class=\"differs\""));
  BOOST_TEST(!contains(page, "nan"));

  const auto flat = block(figs / "2pi.dat", 0), helical = block(figs / "2pi.dat", 4);
  BOOST_REQUIRE(flat.size() > 5u);
  for (const auto& row :
       flat)  // tails of 12 ρ at T >= 1.28: exp(-2 √T 12) is below the run's tolerance of 1e-8
    BOOST_TEST(std::abs(row[1] / capstan::total_force(row[0], 2.0 * M_PI) - 1.0) < 1e-7);
  BOOST_REQUIRE(helical.size() > 5u);
  for (const auto& row : helical)
    BOOST_TEST(row[0] < 1.2860);                  // only below the loss of stability of the flat coil
  BOOST_TEST(block(figs / "pi.dat", 1).empty());  // a half turn is never unstable
  BOOST_TEST(block(figs / "pi.dat", 4).empty());

  std::istringstream limits(slurp(figs / "contact-force-limits.dat"));
  std::string heading;
  std::getline(limits, heading);
  for (const double phi : {4.0, 2.0, 1.0, 0.5, 0.25}) {
    std::string line;
    BOOST_REQUIRE(std::getline(limits, line));
    // Finite tails move the limit by exp(-2 √T L_tail), most for π: L_tail = 13, 1e-8.
    BOOST_TEST(std::abs(std::stod(line) / capstan::line_limit(phi * M_PI) - 1.0) < 1e-6, line);
  }

  // Rods that touch themselves: one turn at R/r = 2.5, where README.md has the tensions.
  std::istringstream map(slurp(figs / "crossing-map-2pi.dat"));
  for (std::string line; std::getline(map, line);) {
    double ratio = 0.0, opens = 0.0, splits = 0.0, on_cylinder = 0.0;
    if (!(std::istringstream(line) >> ratio >> opens >> splits >> on_cylinder) || ratio != 2.5) continue;
    BOOST_TEST(opens == 1.251233258, boost::test_tools::tolerance(1e-8));
    BOOST_TEST(splits == 4.989572779, boost::test_tools::tolerance(1e-8));
    BOOST_TEST(on_cylinder > splits);
  }
  // Two turns: the thickness counts in ρ alone where no strand touches another, below the opening of the crossing.
  const auto lowest = [&](const char* name) {
    std::istringstream rows(slurp(figs / name));
    std::string heading;
    std::getline(rows, heading);
    double tension = 0.0, force = 0.0;
    rows >> tension >> force;
    BOOST_TEST(tension == 0.1);
    return force;
  };
  // The knot beside the coils: what does not collapse is told in percent, and what its contact with the cylinder is.
  const auto said = [&](const char* figure, const std::string& part) {
    for (const auto& statement : summary["statements"][figure])
      if (contains(statement["here"].get<std::string>(), part)) return true;
    return false;
  };
  BOOST_TEST(said("clove-hitch", "% at T = 0.5"));
  BOOST_TEST(said("clove-hitch", "R/r = 2.5, T = 2: "));
  BOOST_TEST(said("clove-hitch", "R/r = 2.5, T = 10: "));
  BOOST_TEST(said("pressure-map", "at T = 0.9 on the cylinder 2 lines"));
  BOOST_TEST(!contains(summary["statements"]["pressure-map"].dump(), "not reached"));  // T = 7 neither
  // Slopes fall to 1 from T = 1/2 on, each known to better than what it falls by.
  std::istringstream slopes(slurp(figs / "clove-hitch-slopes.dat"));
  std::getline(slopes, heading);
  double slope_before = 0.0;
  for (double ratio, tension, slope, error; slopes >> ratio >> tension >> slope >> error;) {
    BOOST_TEST(error < 1e-4);
    if (tension > 0.5) BOOST_TEST(slope < slope_before - error);
    BOOST_TEST(slope > 1.0);
    slope_before = slope;
  }
  BOOST_TEST(slope_before > 0.0);
  BOOST_TEST(contains(slurp(figs / "pressure-clove-hitch-0.3.dat"), "f between strands"));
  // Sliding through a rod on a plate: the verdict is at 1e-10 and index 0 at five angles; the fold is that of an
  // independent step size (4 digits beyond what is drawn), T = 1/2 that of PHYSICS.
  const auto statements = summary["statements"]["sliding"];
  BOOST_TEST(statements[0]["verdict"] == "agrees", statements[0].dump());
  BOOST_TEST(said("sliding", "two touches at T = 0.500000000 (4π) and 0.500000000 (2π)"));
  BOOST_TEST(statements[1]["verdict"] == "agrees", statements[1].dump());
  BOOST_TEST(said("sliding", "up to a fold at T = 0.4381965"));
  BOOST_TEST(said("sliding", "2π at T = 0.3 (1)"));
  BOOST_TEST(!contains(statements.dump(), "no plateau"));
  for (const auto& row : block(figs / "sliding-plate-2pi.dat", 0))  // tails of 32 ρ: rounding is left
    if (row[0] > 0.5) BOOST_TEST(std::abs(row[1] / capstan::total_force(row[0], 2.0 * M_PI) - 1.0) < 1e-10);
  const auto dragged = block(figs / "sliding-plate-2pi-dragged.dat", 0),
             beyond = block(figs / "sliding-plate-2pi-dragged.dat", 1);
  BOOST_REQUIRE(dragged.size() > 5u);
  BOOST_REQUIRE(beyond.size() > 5u);
  for (const auto& row : beyond) BOOST_TEST(row[1] < dragged.back()[1] + 1e-3);  // the lower arm
  BOOST_TEST(lowest("two-turns-1.dat") == lowest("two-turns-5.dat"), boost::test_tools::tolerance(1e-7));
  BOOST_TEST(run_program({"figures", "--out", "figs"}, folder.path()).status == 1);  // not empty
}

BOOST_AUTO_TEST_SUITE_END()
