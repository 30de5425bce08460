// A strut between plane walls (Domokos, Holmes and Royce, J. Nonlinear Sci. 7, 1997) against independent shooting at finite
// distances and against the closed forms of small deflections: first touch, onset of line contact, buckling of the part
// that lies on the wall.
#include <boost/numeric/odeint.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/walker.hpp>
#include <functional>

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

// ---- the oracle: the planar elastica from one end, by Runge-Kutta-Fehlberg 7(8) in long double -------------------

using Real = long double;
using State = std::array<Real, 4>;  // θ, κ, x, y; EI = 1

/// One end of the strut to the wall: from (0, 0), thrust P along e_x and a transverse force V at the end.
State elastica(Real angle, Real curvature, Real thrust, Real transverse, Real length) {
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real> stepper;
  State state{angle, curvature, 0, 0};
  const auto rates = [&](const State& at, State& rate, Real) {
    // θ' = κ, κ' = n_x sin θ − n_y cos θ with n = (−P, V)
    rate = {at[1], -thrust * std::sin(at[0]) - transverse * std::cos(at[0]), std::cos(at[0]),
            std::sin(at[0])};
  };
  constexpr int steps = 200;  // error (0.06)^8 at the largest thrust: below 1e-13
  for (int k = 0; k < steps; ++k) stepper.do_step(rates, state, length * k / steps, length / steps);
  return state;
}

/// Newton's method with differences, for as many unknowns as equations.
Eigen::VectorXd shoot(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residual,
                      Eigen::VectorXd x) {
  for (int k = 0; k < 60; ++k) {
    const Eigen::VectorXd f = residual(x);
    Eigen::MatrixXd j(f.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double step = 1e-6 * std::max(1.0, std::abs(x(i)));
      Eigen::VectorXd up = x, down = x;
      up(i) += step, down(i) -= step;
      j.col(i) = (residual(up) - residual(down)) / (2.0 * step);
    }
    const Eigen::VectorXd dx = -j.fullPivLu().solve(f);
    x += dx;
    if ((dx.array().abs() / x.array().abs().max(1.0)).maxCoeff() < 1e-13) return x;
  }
  BOOST_FAIL("the oracle did not converge");
  return x;
}

struct Event {
  double shortening, thrust;
};

/// What holds at an event besides contact with the wall at y = h, tangentially: of a half of the strut, L = 1.
enum class Kind { touch, line, buckling };

/// Shooting for (P, V, what is free at the end, length of the free part).
Event event_at(Kind kind, bool clamped, double h) {
  const double pi = M_PI, euler = (clamped ? 4.0 : 1.0) * pi * pi;
  const double factor = kind == Kind::touch ? 1.0 : kind == Kind::line ? 4.0 : clamped ? 9.0 : 16.0;
  const double free = kind != Kind::buckling ? 0.5 : clamped ? 1.0 / 3.0 : 0.25;  // of small deflections
  // Small deflections: y = h (1 − cos kx)/2, h sin kx, or with V at the end h (kx − sin kx)/2π, h (kx + sin kx)/π.
  const double k = std::sqrt(factor * euler);
  Eigen::VectorXd guess(4);
  guess << factor * euler, 0.0, 0.0, free;
  if (kind == Kind::touch)
    guess(2) = clamped ? 0.5 * h * k * k : h * k;
  else
    guess(1) = -h * k * k * k / (clamped ? 2.0 * pi : pi), guess(2) = clamped ? 0.0 : 2.0 * h * k / pi;
  const auto end = [&](const Eigen::VectorXd& x) {
    return clamped ? elastica(0, x(2), x(0), x(1), x(3)) : elastica(x(2), 0, x(0), x(1), x(3));
  };
  const auto residual = [&](const Eigen::VectorXd& x) {
    const State at = end(x);
    // On the wall: no curvature there, at[1] = 0. With H = κ²/2 + n·t the same at both ends, and t too, a clamped end then
    // has none either. The tangent at the wall is a double root, x(2) = 0 a simple one that says the same.
    const bool by_curvature = clamped && kind != Kind::touch;
    Eigen::VectorXd f(4);
    f << (by_curvature ? Real(x(2)) : at[0]), at[3] - h, kind == Kind::touch ? Real(x(1)) : at[1],
        kind == Kind::buckling ? x(0) * std::pow(1.0 - 2.0 * x(3), 2) / (4.0 * pi * pi) - 1.0 : x(3) - 0.5;
    return f;
  };
  const Eigen::VectorXd x = shoot(residual, guess);
  return {2.0 * static_cast<double>(x(3) - end(x)[2]), x(0)};
}

/// Eigenvalues, ascending, of the second variation in the plane of a clamped strut that lies on the wall between two free
/// parts: ∫ δθ'² + (n·d) δθ² ds over both, against ∫ δθ² ds, with δy = 0 where the line begins and δx = 0 between the
/// ends. Linear elements in δθ, whose eigenvalues are above the right ones by the square of their size.
Eigen::VectorXd variations_beside_the_line(double thrust, double h, int elements) {
  const double k = std::sqrt(thrust);
  Eigen::VectorXd guess(2);
  guess << -h * k * k * k / (2.0 * M_PI), 2.0 * M_PI / k;
  const auto at_line = [&](const Eigen::VectorXd& x) {
    const State at = elastica(0, 0, thrust, x(0), x(1));
    return Eigen::VectorXd(Eigen::Vector2d(at[1], at[3] - h));
  };
  const Eigen::VectorXd x = shoot(at_line, guess);
  const double transverse = x(0), size = x(1) / elements;
  const int inner = elements - 1, both = 2 * inner;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(both, both), mass = stiffness,
                  held = Eigen::MatrixXd::Zero(3, both);
  for (int e = 0; e < elements; ++e)
    for (const double at : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
      const auto angle = static_cast<double>(elastica(0, 0, thrust, transverse, (e + at) * size)[0]);
      const double weight = 0.5 * size, load = -thrust * std::cos(angle) + transverse * std::sin(angle);
      const Eigen::Vector2d shape(1.0 - at, at), slope(-1.0 / size, 1.0 / size);
      for (int part = 0; part < 2; ++part)
        for (int i = 0; i < 2; ++i) {
          if (e + i < 1 || e + i > inner) continue;
          const int row = part * inner + e + i - 1;
          held(part, row) += weight * std::cos(angle) * shape(i);
          held(2, row) += weight * std::sin(angle) * shape(i);
          for (int j = 0; j < 2; ++j) {
            if (e + j < 1 || e + j > inner) continue;
            const int column = part * inner + e + j - 1;
            stiffness(row, column) += weight * (slope(i) * slope(j) + load * shape(i) * shape(j));
            mass(row, column) += weight * shape(i) * shape(j);
          }
        }
    }
  const Eigen::MatrixXd free = Eigen::FullPivLU<Eigen::MatrixXd>(held).kernel();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
             free.transpose() * stiffness * free, free.transpose() * mass * free, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

// ---- the program ---------------------------------------------------------------------------------------------------

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
      BOOST_TEST(std::abs(point->p(0) / line - 1.0) < 1e-8, "clamped " << clamped << ": " << point->p(0));
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
