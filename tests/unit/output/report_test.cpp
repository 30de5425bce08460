#include "windlass/output/report.hpp"

#include <boost/test/unit_test.hpp>
#include <cstdio>
#include <fstream>

#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"
#include "windlass/output/error.hpp"

namespace {

namespace fs = std::filesystem;
using namespace windlass;

/// Output of a shell command, stderr included.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  pclose(pipe);
  return text;
}

/// True when the report can be made, i.e. Plotly was there at build time.
bool built_with_plotly(const fs::path& run) {
  try {
    output::write_report(output::read_run(run));
    return true;
  } catch (const output::OutputError& error) {
    BOOST_TEST(std::string(error.what()).find("npm") != std::string::npos);
    BOOST_TEST_MESSAGE("skipped: " << error.what());
    return false;
  }
}

std::string attribute(const std::string& page, const std::string& name) {
  const std::size_t at = page.find(name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + name.size() + 2;
  return page.substr(begin, page.find('"', begin) - begin);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(report)

BOOST_AUTO_TEST_CASE(data_hold_every_point_and_its_rod) {
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  const output::Run run = output::read_run(temporary / "run");
  const auto data = output::report_data(run, {});
  std::size_t points = 0;
  for (const auto& branch : data["branches"]) {
    points += branch["names"].size();
    for (const auto& column : branch["values"]) BOOST_TEST(column.size() == branch["names"].size());
    for (const auto& name : branch["names"]) BOOST_TEST(data["rods"].contains(name.get<std::string>()));
  }
  BOOST_TEST(points == run.rows.size());
  const auto& rod = data["rods"]["BP1"];
  BOOST_TEST(rod["forces"].size() == 2u);
  BOOST_TEST(rod["forces"][0]["f"].get<double>() == std::sqrt(4 * 1.6 - 1) / 2,
             boost::test_tools::tolerance(1e-4));
  BOOST_TEST(rod["mode"]["plane"] == "out");
  BOOST_TEST(rod["mode"]["r"].size() == rod["mode"]["d"].size());
  BOOST_TEST(data.dump().find("nan") == std::string::npos);
  output::ReportOptions few;
  few.most_rods = 10;
  std::size_t completed = 0;
  few.complete = [&](std::size_t position, equilibrium::Solution& solution) {
    BOOST_TEST(solution.T == run.points.get(position).T);
    solution.stability->eigenvalues = {7.0};
    ++completed;
  };
  const auto thinned = output::report_data(run, few);
  BOOST_TEST(thinned["rods"].size() < 15u);
  BOOST_TEST(thinned["rods"].contains("BP1"));
  BOOST_TEST(thinned["rods"].size() == completed);
  BOOST_TEST(thinned["rods"]["BP1"]["eigenvalues"][0] == 7.0);
}

BOOST_AUTO_TEST_CASE(a_thick_rod_has_its_radius_and_names_partners) {
  const test::TemporaryFolder temporary;
  auto solution = test::planar_capstan(2.0, 2 * std::numbers::pi);
  solution.joints[1].partner = 2, solution.joints[2].partner = 1;
  solution.joints[1].strand_force = solution.joints[2].strand_force = solution.self_force = 0.125;
  auto writer = output::RunWriter::create(temporary / "run", test::capstan_scene(2.0, 1.0), {});
  writer.add_point(output::make_row(solution, 1, 1, "", "start", 0.1), solution);
  writer.finish("finished", {}, {});
  output::ReportOptions options;
  options.rod_radius = 0.25;
  const auto data = output::report_data(output::read_run(temporary / "run"), options);
  BOOST_TEST(data["radius"] == 0.25);
  BOOST_TEST(data["branches"][0]["values"]["self_force"][0] == 0.125);
  std::size_t strands = 0;
  for (const auto& force : data["rods"]["1-1"]["forces"]) {
    if (!force.contains("partner")) continue;
    BOOST_TEST(force["partner"] == -force["s"].get<double>());
    BOOST_TEST(force["f"] == 0.125);
    ++strands;
  }
  BOOST_TEST(strands == 2u);
}

BOOST_AUTO_TEST_CASE(plates_are_drawn_where_the_surface_of_the_rod_meets_them) {
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  output::ReportOptions options;
  options.rod_radius = 0.25;
  options.plates = {{.height = 0.5}, {.height = -1.0, .side = scene::PlateSide::below, .outer_radius = 2.0}};
  const auto data = output::report_data(output::read_run(temporary / "run"), options);
  BOOST_REQUIRE(data["plates"].size() == 2u);
  BOOST_TEST(data["plates"][0]["z"] == 0.75);
  BOOST_TEST(data["plates"][0]["outer"].is_null());
  BOOST_TEST(data["plates"][1]["z"] == -1.25);
  BOOST_TEST(data["plates"][1]["outer"] == 2.0);
  const auto named = [&](const char* name) {
    return std::ranges::any_of(data["quantities"], [&](const auto& one) { return one["name"] == name; });
  };
  BOOST_TEST(named("F0"));
  BOOST_TEST(named("plate_force"));
}

BOOST_AUTO_TEST_CASE(page_is_self_contained) {
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  if (!built_with_plotly(temporary / "run")) return;
  const std::string page = output::read_file(temporary / "run/report.html");
  for (const char* outside : {"<script src", "<link rel=\"stylesheet", "@import"}) {
    BOOST_TEST(page.find(outside) == std::string::npos, outside);
  }
  BOOST_TEST(page.find("/*DATA*/") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(clicking_a_point_changes_the_rod) {
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  if (!built_with_plotly(temporary / "run")) return;
  if (output_of("command -v chromium").empty()) {
    BOOST_TEST_MESSAGE("chromium is not installed: skipped");
    return;
  }
  // a visitor who clicks point 2-20, hides branch 1 and bends the rod by its mode; findings go into the document
  std::ofstream(temporary / "run/report.html", std::ios::app) << R"(<script>
    const body = document.body.dataset, rod = document.getElementById("rod"), diagram = document.getElementById("diagram");
    const reach = () => Math.max(...rod.data.filter((t) => t.type === "scatter3d").flatMap((t) => t.z).map((z) => Math.abs(z || 0)));
    body.first = body.point; body.firstReach = reach();
    const {xaxis, yaxis} = diagram._fullLayout, box = diagram.getBoundingClientRect();
    const trace = diagram.data.find((t) => (t.customdata || []).includes("2-20")), at = trace.customdata.indexOf("2-20");
    diagram.dispatchEvent(new MouseEvent("click", {clientX: box.left + xaxis._offset + xaxis.d2p(trace.x[at]),
      clientY: box.top + yaxis._offset + yaxis.d2p(trace.y[at])}));
    body.second = body.point; body.secondReach = reach();
    body.traces = diagram.data.length;
    document.querySelector("[data-branch='1']").click();
    body.fewer = diagram.data.length;
    const slider = document.getElementById("amplitude");
    slider.value = 1; slider.dispatchEvent(new Event("input"));
    body.mode = rod.data[0].visible;
    document.getElementById("y").value = "tilt"; document.getElementById("y").dispatchEvent(new Event("change"));
    body.up = diagram.layout.yaxis.title.text;
  </script>)";
  const std::string page = output_of(
      "chromium --headless --no-sandbox --disable-gpu --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--enable-logging=stderr --virtual-time-budget=10000 --user-data-dir='" +
      (temporary / "profile").string() + "' --dump-dom 'file://" + (temporary / "run/report.html").string() +
      "'");
  // errors reach the log as `...:CONSOLE:LINE] "Uncaught ..."`; Plotly's own text holds that word too
  BOOST_TEST(page.find("] \"Uncaught") == std::string::npos);
  BOOST_TEST(page.find("ERROR:CONSOLE") == std::string::npos);
  BOOST_TEST(attribute(page, "data-ready") == "yes");
  BOOST_TEST(attribute(page, "data-first") == "BP1");
  BOOST_TEST(std::stod("0" + attribute(page, "data-first-reach")) < 1e-12);  // planar
  BOOST_TEST(attribute(page, "data-second") == "2-20");
  BOOST_TEST(std::stod("0" + attribute(page, "data-second-reach")) > 0.5);  // helical
  BOOST_TEST(std::stoi("0" + attribute(page, "data-fewer")) <
             std::stoi("0" + attribute(page, "data-traces")));
  BOOST_TEST(attribute(page, "data-mode") == "true");
  BOOST_TEST(attribute(page, "data-up") == "tilt at the mid-point [rad]");
}

BOOST_AUTO_TEST_SUITE_END()
