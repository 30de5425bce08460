#include "windlass/output/plot.hpp"

#include <boost/test/unit_test.hpp>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/rod_curve.hpp"

namespace {

namespace fs = std::filesystem;
using namespace windlass;
using output::BranchRow;

constexpr double two_pi = 2 * std::numbers::pi;

/// Rows of the closed-form branch at `count` tensions from 5 to 0.6, spaced unevenly.
std::vector<BranchRow> closed_form_rows(int count) {
  std::vector<BranchRow> rows;
  for (int i = 0; i < count; ++i) {
    const double x = i / (count - 1.0), T = 5.0 * std::pow(0.12, x * (0.7 + 0.3 * x));
    rows.push_back(output::make_row(test::planar_capstan(T, two_pi), 1, i + 1, "", "regular", 0.1));
  }
  return rows;
}

double largest_slope_error(int count) {
  const auto rows = closed_form_rows(count);
  const auto slopes = output::log_slopes(rows);
  double worst = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    worst = std::max(worst, std::abs(slopes[i] - (1 + rows[i].phi_star / rows[i].R_tot)));  // PHYSICS
  }
  return worst;
}

/// Picture files start with these bytes.
std::string magic(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(5, '\0');
  stream.read(bytes.data(), 5);
  return bytes;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(plot)

BOOST_AUTO_TEST_CASE(alpha_converges_at_second_order) {
  const double coarse = largest_slope_error(41), fine = largest_slope_error(81);
  BOOST_TEST(coarse < 0.02);
  BOOST_TEST(coarse / fine > 3.3);
}

BOOST_AUTO_TEST_CASE(alpha_is_one_sided_where_the_topology_changes) {
  std::vector<BranchRow> rows;
  for (int i = 0; i < 12; ++i) {
    BranchRow row;
    row.T = 4.0 * std::pow(0.9, i);
    row.topology = i < 6 ? "line" : "touch";
    row.R_tot = i < 6 ? std::pow(row.T, 2) : std::pow(row.T, 0.5);  // a kink, and a jump
    rows.push_back(row);
  }
  const auto slopes = output::log_slopes(rows);
  for (int i = 0; i < 12; ++i) {
    BOOST_TEST(slopes[static_cast<std::size_t>(i)] == (i < 6 ? 2.0 : 0.5),
               boost::test_tools::tolerance(1e-10));
  }
}

BOOST_AUTO_TEST_CASE(alpha_is_undefined_at_a_fold_only) {
  std::vector<BranchRow> rows;
  for (int i = -5; i <= 5; ++i) {
    BranchRow row;
    row.T = std::exp(0.01 * i * i), row.R_tot = std::exp(0.1 * i), row.topology = "line";
    rows.push_back(row);
  }
  const auto slopes = output::log_slopes(rows);
  for (int i = -5; i <= 5; ++i) BOOST_TEST(std::isnan(slopes[static_cast<std::size_t>(i + 5)]) == (i == 0));
}

BOOST_AUTO_TEST_CASE(dense_curve_lies_on_the_circle_and_the_tail) {
  const auto curve = output::dense_curve(test::planar_capstan(1.0, two_pi), 0.02);
  double off = 0.0;
  for (std::size_t i = 0; i < curve.s.size(); ++i) {
    if (curve.arc[i] == 1) off = std::max(off, std::abs(curve.r[i].norm() - 1));
    if (i > 0) BOOST_TEST(curve.s[i] >= curve.s[i - 1]);
  }
  BOOST_TEST(off < 1e-4);
  BOOST_TEST(output::point_forces(test::planar_capstan(1.0, two_pi)).size() == 2u);
}

BOOST_AUTO_TEST_CASE(pictures_scripts_and_data_are_made) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) {
    BOOST_TEST_MESSAGE("gnuplot is not installed: skipped");
    return;
  }
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  output::PlotOptions options;
  options.points = {"BP1", "2-3"};
  const auto pictures = output::plot_run(temporary / "run", options);
  BOOST_TEST(pictures.size() == 9u);
  for (const fs::path& picture : pictures) {
    BOOST_TEST(fs::file_size(picture) > 4000u, picture);
    const std::string start = magic(picture), kind = picture.extension().string();
    BOOST_TEST(start == (kind == ".png" ? "\x89PNG\r" : kind == ".svg" ? "<?xml" : "%PDF-"), picture);
  }
  for (const char* file :
       {"diagram.gp", "diagram.dat", "diagram-special.dat", "rod-BP1.gp", "rod-2-3-side.dat"}) {
    const fs::path path = temporary / "run/plots" / file;
    BOOST_REQUIRE(fs::exists(path));
    BOOST_TEST(output::read_file(path).find("nan") == std::string::npos);
    BOOST_TEST(output::read_file(path).find(temporary.path().string()) == std::string::npos,
               "names no absolute path");
  }
  options.points = {"BP7"};
  BOOST_CHECK_THROW(output::plot_run(temporary / "run", options), output::OutputError);
  options.points.clear(), options.formats = {"gif"};
  BOOST_CHECK_THROW(output::plot_run(temporary / "run", options), output::OutputError);
}

BOOST_AUTO_TEST_CASE(a_thick_rod_is_drawn_with_its_width) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) return;
  const test::TemporaryFolder temporary;
  output::PlotOptions options;
  options.formats = {"png@60"};
  options.rod_radius = 0.25;
  auto solution = test::planar_capstan(1.0, two_pi);
  solution.joints[1].partner = 2, solution.joints[2].partner = 1;  // as if the two edges touched each other
  solution.joints[1].strand_force = solution.joints[2].strand_force = 0.1;
  output::plot_rod(solution, "thick", options, temporary.path(), "thick");
  BOOST_TEST(magic(temporary / "thick.png") == "\x89PNG\r");
  double widest = 0.0;
  std::istringstream data(output::read_file(temporary / "thick-axis.dat"));
  for (std::string line; std::getline(data, line) && line.find("# cylinder") != 0;) {
    double x = 0.0, y = 0.0;
    if (std::sscanf(line.c_str(), "%lf %lf", &x, &y) == 2 && y < 0.0)
      widest = std::max(widest, std::hypot(x, y));
  }
  BOOST_TEST(widest == 1.25, boost::test_tools::tolerance(1e-3));  // the outside of the coil
  BOOST_TEST(output::read_file(temporary / "thick.gp").find("between strands") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_plate_is_drawn_in_the_side_view) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) return;
  const test::TemporaryFolder temporary;
  output::PlotOptions options;
  options.formats = {"png@60"};
  options.plates = {scene::Plate{.height = 0.3}};
  auto solution = test::planar_capstan(1.0, two_pi);
  solution.z_span = 0.3;  // as if it left its plane: those that do not have no side view
  output::plot_rod(solution, "plate", options, temporary.path(), "plate");
  std::istringstream data(output::read_file(temporary / "plate-side.dat"));
  for (std::string line; std::getline(data, line) && line != "# plate: right up";) {
  }
  // A circle in a plane seen from 0.35 above it is an ellipse round the projection of its centre.
  int places = 0;
  double x = 0.0, y = 0.0, radius = 0.0;
  for (std::string line; std::getline(data, line);) {
    if (std::sscanf(line.c_str(), "%lf %lf", &x, &y) != 2) continue;
    const double here = std::hypot(x, (y - 0.3 * std::cos(0.35)) / std::sin(0.35));
    if (places++ == 0) radius = here;
    BOOST_TEST(here == radius, boost::test_tools::tolerance(1e-6));
  }
  BOOST_TEST(places > 100);
}

BOOST_AUTO_TEST_CASE(a_locus_is_one_curve_without_stability) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) return;
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  output::Run run = output::read_run(temporary / "run");
  run.info.command = "locus", run.info.options["of"] = "B1";
  output::PlotOptions options;
  options.formats = {"svg"};
  output::plot_diagram(run, options, temporary.path(), "diagram");
  const std::string picture = output::read_file(temporary / "diagram.svg");
  BOOST_TEST(picture.find("locus of B1") != std::string::npos);
  for (const char* word : {"stable", "branch 2", "not computed"})
    BOOST_TEST(picture.find(word) == std::string::npos, word);
}

BOOST_AUTO_TEST_CASE(struts_are_drawn_too) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) return;
  const test::TemporaryFolder temporary;
  auto scene = test::capstan_scene(1.0, 1.0);
  scene.name = "strut", scene.has_cylinder = false;
  {
    auto writer = output::RunWriter::create(temporary / "run", scene, {});
    for (int i = 0; i < 12; ++i) {
      // shallow buckled shape y = a (1 + cos 2πx)/2, only to have something to draw
      const double a = 0.02 * i;
      auto arc = test::empty_arc(equilibrium::ArcKind::free, "gap", 21);
      for (int k = 0; k <= 20; ++k) {
        const double x = k / 20.0 - 0.5;
        test::set_planar(arc, k, x, {x, a * (1 + std::cos(two_pi * x)) / 2},
                         -a * std::numbers::pi * std::sin(two_pi * x), 0, {-40, 0});
      }
      test::Solution solution;
      solution.has_cylinder = false, solution.end_force = 39.5 + 5 * a, solution.shortening = 2.4 * a * a;
      solution.arcs = {arc}, solution.joints.resize(2), solution.topology = "gap";
      writer.add_point(output::make_row(solution, 1, i + 1, "", "regular", 0.1), solution);
    }
    writer.finish("finished", {}, nlohmann::ordered_json::object());
  }
  output::PlotOptions options;
  options.formats = {"png"};
  BOOST_TEST(output::plot_run(temporary / "run", options).size() == 3u);
}

BOOST_AUTO_TEST_SUITE_END()
