// A strut between plane walls (Domokos, Holmes and Royce, J. Nonlinear Sci. 7, 1997) against independent
// shooting at finite distances and against the closed forms of small deflections: first touch, onset of line
// contact, buckling of the part that lies on the wall.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/walker.hpp>

#include "wall_shooting.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/analysis.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;
using continuation::Point;
using continuation::PointType;
using equilibrium::Solution;
using equilibrium::Started;
using test::event_at, test::variations_beside_the_line;
using Event = test::WallEvent;
using Kind = test::WallEventKind;

/// A strip: stiff against bending along the walls, so that its states lie in the plane.
scene::Scene between_walls(bool clamped, double h) {
  scene::Scene scene;
  scene.name = "strut";
  scene.rod.length = 1.0;
  scene.rod.bending_stiffness_2 = 20.0;
  scene.ends.kind = clamped ? scene::EndKind::clamped : scene::EndKind::pinned;
  scene.ends.shortening = 0.0;
  scene.walls = {{{0.0, 1.0, 0.0}, h}, {{0.0, -1.0, 0.0}, h}};
  scene.model.tolerance = 1e-11;
  return scene;
}

struct Walk {
  std::vector<Point> points;
  std::vector<Solution> states;                 ///< of the points
  std::vector<int> index;                       ///< of the whole rod
  std::vector<equilibrium::Stability> on_line;  ///< spectra of the states that lie on the wall
};

/// Follows the strut as its ends come together, from a slight bow on.
Walk walk(scene::Scene scene, double target, bool half = true, int most_events = 1000) {
  scene.ends.shortening = 1e-3 * target;
  Started start = equilibrium::cold_start(scene, true, half, {"ends.shortening"});
  continuation::Options options;
  options.target = target;
  options.parameter_scale = 0.2 * target;
  continuation::Walker walker(start.problem, start.x, start.p, options);
  Walk out;
  stability::SpectrumSolver solver;
  while (const auto point = walker.step()) {
    auto& problem = dynamic_cast<equilibrium::RodProblem&>(*point->problem);
    out.points.push_back(*point);
    out.states.push_back(equilibrium::record(problem, point->x, point->p));
    out.index.push_back(problem.total_index(point->x, point->p));
    if (out.states.back().topology == "tail line:2 tail")
      out.on_line.push_back(stability::analyse(problem, point->x, point->p, 2, false, solver));
    if (point->type == PointType::event && --most_events == 0) break;
  }
  if (most_events > 0) BOOST_TEST(!walker.end().lost(), walker.end().reason);
  return out;
}

std::vector<std::size_t> events_of(const Walk& walk) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < walk.points.size(); ++k)
    if (walk.points[k].type == PointType::event) out.push_back(k);
  return out;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(walls)

BOOST_AUTO_TEST_CASE(the_oracle_has_the_loads_of_small_deflections) {
  // Touch at Euler's load, line contact at 4 times that; the flat part buckles at 9 (clamped) and 16 (pinned) times: the
  // free parts have k a = 2π (π), the flat one k l = 2π. The error goes with h².
  for (const bool clamped : {true, false}) {
    const double euler = (clamped ? 4.0 : 1.0) * M_PI * M_PI;
    const std::pair<Kind, double> loads[] = {
        {Kind::touch, 1.0}, {Kind::line, 4.0}, {Kind::buckling, clamped ? 9.0 : 16.0}};
    for (const auto& [kind, factor] : loads)
      for (const double h : {1e-3, 1e-4})
        BOOST_TEST(std::abs(event_at(kind, clamped, h).thrust / euler / factor - 1.0) < 100.0 * h * h);
  }
}

BOOST_AUTO_TEST_CASE(touch_line_contact_and_its_buckling_are_where_shooting_finds_them) {
  for (const bool clamped : {true, false})
    for (const double h : {0.02, 0.05, 0.1}) {
      const Event last = event_at(Kind::buckling, clamped, h);
      const Walk run = walk(between_walls(clamped, h), 1.1 * last.shortening, true, 3);
      const std::vector<std::size_t> events = events_of(run);
      BOOST_TEST_REQUIRE(events.size() >= 3u, "h = " << h);
      const char* const after[] = {"tail touch:2 tail", "tail line:2 tail", "tail touch:2 gap touch:2 tail"};
      const Kind kinds[] = {Kind::touch, Kind::line, Kind::buckling};
      for (int k = 0; k < 3; ++k) {
        const Point& point = run.points[events[k]];
        const Event expected = event_at(kinds[k], clamped, h);
        BOOST_TEST(point.after == after[k]);
        constexpr double bound = 1e-8;
        BOOST_TEST(std::abs(point.p(0) / expected.shortening - 1.0) < bound,
                   "clamped " << clamped << ", h = " << h << ", event " << k << ": " << point.p(0)
                              << ", shooting " << expected.shortening);
        BOOST_TEST(std::abs(run.states[events[k]].end_force / expected.thrust - 1.0) < bound);
      }
    }
}

BOOST_AUTO_TEST_CASE(every_state_passes_its_certificate) {
  scene::Scene scene = between_walls(true, 0.05);
  const Walk run = walk(scene, 1.2 * event_at(Kind::buckling, true, 0.05).shortening);
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    scene.ends.shortening = run.points[k].p(0);
    const verify::Certificate certificate = verify::verify(run.states[k], scene);
    BOOST_TEST(certificate.passed(), run.states[k].topology << " at " << run.points[k].p(0) << "\n"
                                                            << verify::to_text(certificate));
  }
}

BOOST_AUTO_TEST_CASE(on_the_line_two_modes_cost_nothing_and_none_is_negative) {
  const double h = 0.05;
  for (const double thrust : {165.0, 250.0, 340.0}) {
    const Eigen::VectorXd coarse = variations_beside_the_line(thrust, h, 40),
                          fine = variations_beside_the_line(thrust, h, 80);
    // Each free part has one, zero but for the elements' error, which a finer mesh divides by four.
    for (int k = 0; k < 2; ++k) BOOST_TEST(fine(k) / coarse(k) == 0.25, boost::test_tools::tolerance(0.02));
    BOOST_TEST(std::abs(4.0 * fine(0) - coarse(0)) < 1e-2 * coarse(0));
    BOOST_TEST(fine(2) > 0.1 * thrust);
  }
}

BOOST_AUTO_TEST_CASE(the_index_on_the_wall_does_not_depend_on_the_mesh) {
  // Zero modes have the signs of the mesh's error; finer ones made branch points of them.
  const double h = 0.05, buckles = event_at(Kind::buckling, true, h).shortening;
  for (const double tolerance : {1e-8, 1e-10, 1e-11})
    for (const bool half : {true, false}) {
      scene::Scene scene = between_walls(true, h);
      scene.model.tolerance = tolerance;
      const Walk run = walk(scene, 1.02 * buckles, half, 3);
      for (std::size_t k = 0; k < run.points.size(); ++k) {
        const Point& point = run.points[k];
        BOOST_TEST((point.type != PointType::branch_point),
                   "tolerance " << tolerance << " at " << point.p(0));
        BOOST_TEST(run.index[k] == 0, "tolerance " << tolerance << ", half " << half << " at " << point.p(0));
      }
      BOOST_TEST(run.on_line.size() > 3u);
      for (const equilibrium::Stability& spectrum : run.on_line) {
        BOOST_TEST(spectrum.index == 0);
        BOOST_TEST(spectrum.degenerate);
        // Against the thrust, 160 to 350: the size of mesh and state errors, and far below Chain::neutral_size, 1e-3.
        for (const double zero : spectrum.eigenvalues) BOOST_TEST(std::abs(zero) < 1e-6);
      }
    }
}

BOOST_AUTO_TEST_CASE(the_strut_comes_back_through_the_same_events) {
  for (const bool clamped : {true, false}) {
    const double h = 0.05, line = event_at(Kind::line, clamped, h).shortening,
                 buckles = event_at(Kind::buckling, clamped, h).shortening;
    const Walk there = walk(between_walls(clamped, h), 0.5 * (line + buckles), true);
    const Point& last = there.points.back();
    continuation::Options options;
    options.target = 0.9 * line;  // it leaves the wall at 0.82
    options.parameter_scale = 0.2 * buckles;
    options.direction = -1;
    continuation::Walker walker(last.problem, last.x, last.p, options);
    bool passed = false;
    while (const auto point = walker.step()) {
      BOOST_TEST((point->type != PointType::branch_point));
      if (point->type != PointType::event) continue;
      passed = true;
      BOOST_TEST(point->after == "tail touch:2 tail");
      BOOST_TEST(std::abs(point->p(0) / line - 1.0) < 1e-8,
                 "clamped " << clamped << ": " << point->p(0) << ", off by " << point->p(0) / line - 1.0);
    }
    BOOST_TEST(passed);
    BOOST_TEST(!walker.end().lost(), walker.end().reason);
  }
}

BOOST_AUTO_TEST_CASE(a_strip_stays_on_the_wall_and_a_round_rod_turns_away_from_it) {
  // Turned about the axis of its ends by φ, a bow of height h that the wall pushes with N gains N h φ²/2. A round rod's
  // clamped ends do not resist (each section turns back about its tangent), those of a strip do.
  const double h = 0.02, touch = event_at(Kind::touch, true, h).shortening,
               line = event_at(Kind::line, true, h).shortening;
  scene::Scene round = between_walls(true, h);
  round.rod.bending_stiffness_2 = 1.0;
  for (const bool is_strip : {true, false}) {
    const Walk run = walk(is_strip ? between_walls(true, h) : round, 0.999 * line);
    for (std::size_t k = 0; k < run.points.size(); ++k) {
      const double at = run.points[k].p(0);
      if (std::abs(at - touch) < 1e-6 * touch) continue;  // there the force is zero
      const bool pushed = !is_strip && at > touch;
      BOOST_TEST((pushed ? run.index[k] >= 1 : run.index[k] == 0),
                 "at " << at << ", strip " << is_strip << ": " << run.index[k]);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_twisted_strut_between_walls_in_space) {
  // Its bow leaves the plane; the walls are oblique, so that no half-turn maps them to themselves.
  scene::Scene scene = between_walls(true, 0.06);
  scene.rod.bending_stiffness_2 = 3.0;
  scene.ends.twist = 0.5;
  scene.walls = {{{0.0, 1.0, 0.5}, 0.06}, {{0.0, -1.0, -0.3}, 0.06}};
  BOOST_TEST(!scene.half_turn());
  const Walk run = walk(scene, 0.02, false);
  bool touched = false;
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    touched = touched || run.states[k].R_tot > 1.0;
    scene.ends.shortening = run.points[k].p(0);
    const verify::Certificate certificate = verify::verify(run.states[k], scene);
    BOOST_TEST(certificate.passed(), run.states[k].topology << " at " << run.points[k].p(0) << "\n"
                                                            << verify::to_text(certificate));
  }
  BOOST_TEST(touched);
}

BOOST_AUTO_TEST_CASE(the_line_carries_its_force_at_its_edges) {
  // A straight rod presses nowhere: the wall pushes with point forces where the line ends, in balance with the ends.
  const Walk run = walk(between_walls(true, 0.05), 0.999 * event_at(Kind::buckling, true, 0.05).shortening);
  const Solution& last = run.states.back();
  BOOST_TEST(last.topology == "tail line:2 tail");
  for (const equilibrium::ArcRecord& arc : last.arcs) BOOST_TEST(arc.p.cwiseAbs().maxCoeff() == 0.0);
  BOOST_TEST(last.joints[1].force > 0.0);
  BOOST_TEST(last.joints[1].force == last.joints[2].force, boost::test_tools::tolerance(1e-10));
  BOOST_TEST(last.joints[1].force == last.arcs.front().n(1, 0), boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_SUITE_END()
