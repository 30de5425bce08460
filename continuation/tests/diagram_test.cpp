#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/diagram.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

Options bounded(double lower, double upper) {
  Options options;
  options.lower = lower;
  options.upper = upper;
  options.step = 0.07;
  return options;
}

Point only_branch_point(Walker& walker) {
  const auto found = of_type(walk(walker), PointType::branch_point);
  BOOST_REQUIRE_EQUAL(found.size(), 1u);
  return found[0];
}

struct Recorder : DiagramObserver {
  int starts = 0, points = 0, specials = 0, ends = 0, stop_after = 1 << 30;
  void on_branch_start(const Branch&) override { ++starts; }
  void on_point(const Branch&, const Point&) override { ++points; }
  void on_special_point(const Branch&, const Point&) override { ++specials; }
  void on_branch_end(const Branch&) override { ++ends; }
  bool should_stop() override { return points >= stop_after; }
};

std::shared_ptr<AlgebraicProblem> pitchfork() {
  auto problem = scalar([](double x, const Vector& p) { return -p[0] * x + x * x * x; });
  problem->fingerprint_of = [](const Vector& x, const Vector&) { return Vector(x.cwiseAbs()); };
  return problem;
}

BOOST_AUTO_TEST_SUITE(switching)

BOOST_AUTO_TEST_CASE(pitchfork_has_two_arms_that_are_mirror_images) {
  auto problem = pitchfork();
  Walker walker(problem, vector({0.0}), vector({-1.0}), bounded(-2.0, 1.0));
  const Point point = only_branch_point(walker);
  const Arms named_once = switch_branch(point, bounded(-2.0, 1.0));
  BOOST_REQUIRE_EQUAL(named_once.arms.size(), 1u);
  BOOST_TEST(named_once.arms[0].count == 2);
  BOOST_TEST(named_once.failures.empty());
  // Without the mirror in the fingerprint both are named.
  Point plain = point;
  auto other = pitchfork();
  other->fingerprint_of = {};
  plain.problem = other;
  const Arms both = switch_branch(plain, bounded(-2.0, 1.0));
  BOOST_REQUIRE_EQUAL(both.arms.size(), 2u);
  for (const Arm& arm : both.arms) {
    BOOST_TEST(std::abs(arm.x[0] * arm.x[0] - arm.p[0]) < 1e-10);
    BOOST_TEST(std::abs(arm.x[0]) > 1e-3);
    BOOST_TEST(arm.tangent.x[0] * arm.x[0] > 0.0);  // away from the branch point
  }
  BOOST_TEST(both.arms[0].x[0] * both.arms[1].x[0] < 0.0);
}

BOOST_AUTO_TEST_CASE(transcritical_other_branch) {
  auto problem = scalar([](double x, const Vector& p) {
    const double u = x - std::sin(p[0]);
    return u * (p[0] - 0.4 + u);
  });
  Walker walker(problem, vector({std::sin(-0.5)}), vector({-0.5}), bounded(-1.0, 1.2));
  const Point point = only_branch_point(walker);
  const Arms arms = switch_branch(point, bounded(-1.0, 1.2));
  BOOST_REQUIRE_EQUAL(arms.arms.size(), 2u);
  for (const Arm& arm : arms.arms)
    BOOST_TEST(std::abs(arm.x[0] - std::sin(arm.p[0]) + arm.p[0] - 0.4) < 1e-10);
  BOOST_TEST((arms.arms[0].p[0] - 0.4) * (arms.arms[1].p[0] - 0.4) < 0.0);
}

BOOST_AUTO_TEST_CASE(double_kernel_with_the_symmetry_of_the_square) {
  // λ a = a³ + c a b², λ b = b³ + c b a²: arms along the axes and, with λ = (1 + c) a², along the diagonals.
  const double c = 3.0;
  auto problem = std::make_shared<AlgebraicProblem>(2, [c](const Vector& x, const Vector& p) {
    const double a = x[0], b = x[1];
    return vector({-p[0] * a + a * a * a + c * a * b * b, -p[0] * b + b * b * b + c * b * a * a});
  });
  problem->directions_of = [](const Matrix&) {
    return std::vector<Vector>{vector({1, 0}), vector({0, 1}), vector({1, 1}), vector({1, -1})};
  };
  problem->fingerprint_of = [](const Vector& x, const Vector&) {
    return vector({x.cwiseAbs().maxCoeff(), x.cwiseAbs().minCoeff()});
  };
  Walker walker(problem, vector({0.0, 0.0}), vector({-1.0}), bounded(-2.0, 1.0));
  const Point point = only_branch_point(walker);
  BOOST_TEST(point.multiplicity == 2);
  const Arms arms = switch_branch(point, bounded(-2.0, 1.0));
  BOOST_REQUIRE_EQUAL(arms.arms.size(), 2u);  // one kind along the axes, one along the diagonals
  BOOST_TEST(arms.arms[0].count == 4);
  BOOST_TEST(arms.arms[1].count == 4);
  const Arm& diagonal = arms.arms[1];
  BOOST_TEST(std::abs(diagonal.p[0] - (1.0 + c) * diagonal.x[0] * diagonal.x[0]) < 1e-10);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(diagrams)

BOOST_AUTO_TEST_CASE(pitchfork_diagram) {
  Recorder recorder;
  const Diagram diagram = trace_diagram(pitchfork(), vector({0.0}), vector({-0.5}), bounded(-1.0, 1.0),
                                        {true, true, 50, 3}, recorder);
  BOOST_TEST(diagram.branches.size() == 3u);  // right, left, one arm for both
  BOOST_TEST(diagram.branches[2].count == 2);
  BOOST_TEST(diagram.branches[2].origin == "B1");
  BOOST_TEST(diagram.branches[2].depth == 1);
  BOOST_TEST(diagram.specials.size() == 1u);
  BOOST_TEST(diagram.lost.empty());
  BOOST_TEST(recorder.starts == 3);
  BOOST_TEST(recorder.ends == 3);
  BOOST_TEST(recorder.specials == 1);
  BOOST_TEST((diagram.branches[0].end.kind == End::Kind::bound));
  BOOST_TEST((diagram.branches[2].end.kind == End::Kind::bound));
}

BOOST_AUTO_TEST_CASE(loop_between_two_branch_points_is_walked_once) {
  // x (x² - p (1 - p)) = 0: pitchforks at p = 0 and p = 1 joined by a closed loop.
  auto problem = scalar([](double x, const Vector& p) { return x * (x * x - p[0] * (1.0 - p[0])); });
  problem->fingerprint_of = [](const Vector& x, const Vector&) { return Vector(x.cwiseAbs()); };
  Recorder recorder;
  const Diagram diagram =
      trace_diagram(problem, vector({0.0}), vector({-1.0}), bounded(-2.0, 2.0), {}, recorder);
  BOOST_TEST(diagram.specials.size() == 2u);
  BOOST_REQUIRE_EQUAL(diagram.branches.size(), 2u);
  BOOST_TEST((diagram.branches[1].end.kind == End::Kind::joined));
  BOOST_TEST(diagram.branches[1].end.reason == "joins branch 1 at B2");
  BOOST_TEST(diagram.lost.empty());
}

BOOST_AUTO_TEST_CASE(secondary_branching_limits_and_stopping) {
  // Two pitchforks in series: y branches off x = √p at p = 0.5 and off x = 0.
  const auto make = [] {
    auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
      return vector({-p[0] * x[0] + std::pow(x[0], 3), -(x[0] * x[0] - 0.5) * x[1] + std::pow(x[1], 3)});
    });
    problem->fingerprint_of = [](const Vector& x, const Vector&) { return Vector(x.cwiseAbs()); };
    return problem;
  };
  Recorder recorder;
  const Diagram diagram =
      trace_diagram(make(), vector({0.0, 0.0}), vector({-1.0}), bounded(-2.0, 1.0), {}, recorder);
  BOOST_TEST(diagram.branches.size() == 3u);
  BOOST_TEST(diagram.branches[2].depth == 2);
  BOOST_REQUIRE_EQUAL(diagram.specials.size(), 2u);
  BOOST_TEST(std::abs(diagram.specials[1].point.p[0] - 0.5) < 1e-10);
  BOOST_TEST(diagram.specials[1].branch == 1);
  BOOST_TEST(diagram.lost.empty());

  Recorder shallow;
  const Diagram limited = trace_diagram(make(), vector({0.0, 0.0}), vector({-1.0}), bounded(-2.0, 1.0),
                                        {false, true, 50, 1}, shallow);
  BOOST_TEST(limited.branches.size() == 2u);
  BOOST_REQUIRE_EQUAL(limited.lost.size(), 1u);
  BOOST_TEST(limited.lost[0].find("max_depth") != std::string::npos);

  Recorder few;
  const Diagram narrow =
      trace_diagram(make(), vector({0.0, 0.0}), vector({-1.0}), bounded(-2.0, 1.0), {false, true, 1, 3}, few);
  BOOST_TEST(narrow.branches.size() == 1u);
  BOOST_TEST(narrow.lost.size() == 1u);

  Recorder impatient;
  impatient.stop_after = 5;
  const Diagram stopped =
      trace_diagram(make(), vector({0.0, 0.0}), vector({-1.0}), bounded(-2.0, 1.0), {}, impatient);
  BOOST_TEST(stopped.stopped);
  BOOST_TEST(impatient.points == 5);
  BOOST_TEST(impatient.ends == 1);
}

BOOST_AUTO_TEST_CASE(lost_branches_are_recorded) {
  auto problem = scalar([](double x, const Vector& p) {
    if (std::abs(x) > 0.5) throw std::domain_error("x too large");
    return -p[0] * x + x * x * x;
  });
  Recorder recorder;
  const Diagram diagram =
      trace_diagram(problem, vector({0.0}), vector({-1.0}), bounded(-2.0, 1.0), {}, recorder);
  BOOST_TEST(diagram.branches.size() == 3u);
  BOOST_REQUIRE_EQUAL(diagram.lost.size(), 2u);
  BOOST_TEST(diagram.lost[0].find("x too large") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
