// Starts on folds and branch points, where the Jacobian is singular.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/dense_problem.hpp"
#include "continuation/diagram.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

/// A pitchfork at p = 0 on a branch that moves with p.
std::shared_ptr<DenseProblem> pitchfork() {
  return std::make_shared<DenseProblem>(
      2,
      [](const Vector& x, const Vector& p) {
        return vector({-p[0] * x[0] + std::pow(x[0], 3), x[1] - std::sin(p[0])});
      },
      [](const Vector& x, const Vector& p) {
        Matrix j = Matrix::Identity(2, 2);
        j(0, 0) = -p[0] + 3.0 * x[0] * x[0];
        return j;
      });
}

BOOST_AUTO_TEST_SUITE(starts)

BOOST_AUTO_TEST_CASE(on_a_fold) {
  // At the default tolerance x is known to the square root of p's rounding; a second unknown moves along.
  const auto problem = std::make_shared<DenseProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({p[0] - 1.0 + std::pow(x[0] - 0.3, 2) + 0.2 * (x[1] - x[0]), x[1] - x[0]});
  });
  Options options;
  options.lower = -1.0;
  for (const double beside : {0.0, 1e-9, -1e-9}) {
    Walker walker(problem, vector({0.3 + beside, 0.3 + beside}), vector({1.0}), options);
    const auto points = walk(walker);
    BOOST_TEST((walker.end().kind == End::Kind::bound));
    BOOST_TEST(points.size() > 5u);
    for (const Point& point : points)
      BOOST_TEST(std::abs(point.p[0] - 1.0 + std::pow(point.x[0] - 0.3, 2)) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(on_a_branch_point_which_is_named) {
  Options options;
  options.upper = 1.0;
  Walker walker(pitchfork(), vector({0.0, 0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_REQUIRE(points.size() > 2u);
  BOOST_TEST((points[0].type == PointType::start));
  BOOST_TEST((points[1].type == PointType::branch_point));
  BOOST_TEST(of_type(points, PointType::branch_point).size() == 1u);
  BOOST_TEST(points.back().p[0] == 1.0);
  BOOST_TEST(std::abs(points.back().x[0]) < 1e-9);
  BOOST_TEST(switch_branch(points[1], options).arms.size() == 2u);
}

BOOST_AUTO_TEST_CASE(a_diagram_from_a_branch_point_has_all_four_ways) {
  Options options;
  options.lower = -1.0;
  options.upper = 1.0;
  DiagramOptions both;
  both.both_ways = true;
  DiagramObserver silent;
  const Diagram diagram =
      trace_diagram(pitchfork(), vector({0.0, 0.0}), vector({0.0}), options, both, silent);
  BOOST_REQUIRE_EQUAL(diagram.branches.size(), 4u);
  for (const Branch& branch : diagram.branches) BOOST_TEST((branch.end.kind == End::Kind::bound));
  BOOST_TEST(diagram.specials.size() == 1u);
}

namespace {

/// Keeps all that is reported.
struct Kept : DiagramObserver {
  void on_point(const Branch&, const Point& point) override { points.push_back(point); }
  void on_way_back(const Point&) override { ++way; }
  bool should_stop() override { return way == stop_at; }
  std::vector<Point> points;
  int way = 0, stop_at = -1;
};

Diagram from_inside(const std::shared_ptr<Problem>& problem, double x, double p, Kept& kept) {
  Options options;
  options.lower = -1.0;
  options.upper = options.target = 1.0;
  DiagramOptions limits;
  limits.from_behind = true;
  return trace_diagram(problem, vector({x}), vector({p}), options, limits, kept);
}

}  // namespace

BOOST_AUTO_TEST_CASE(inside_a_branch_that_is_reported_from_its_beginning) {
  // The pitchfork's trivial branch, found at p = 1/4, where its branch point is behind already.
  Kept kept;
  const Diagram diagram =
      from_inside(scalar([](double x, const Vector& p) { return -p[0] * x + x * x * x; }), 0.0, 0.25, kept);
  BOOST_TEST(diagram.lost.empty());
  BOOST_REQUIRE_EQUAL(diagram.branches.size(), 3u);  // and its arms
  const auto of_first = kept.points.begin() + diagram.branches[0].points;
  const std::vector<Point> first(kept.points.begin(), of_first);
  BOOST_TEST(first.front().p[0] == -1.0);
  BOOST_TEST((first.front().type == PointType::start));
  BOOST_TEST(first.back().p[0] == 1.0);
  BOOST_TEST(of_type(first, PointType::start).size() == 1u);
  const auto crossed = of_type(first, PointType::branch_point);
  BOOST_REQUIRE_EQUAL(crossed.size(), 1u);
  BOOST_TEST(crossed[0].label == "B1");
  BOOST_TEST(crossed[0].index == 0);
  BOOST_TEST(crossed[0].index_after == 1);
  for (std::size_t k = 1; k < first.size(); ++k) {
    BOOST_TEST(first[k].p[0] > first[k - 1].p[0]);
    BOOST_TEST(first[k].path_length > first[k - 1].path_length);
    BOOST_TEST(first[k].tangent.p > 0.0);
  }
}

BOOST_AUTO_TEST_CASE(inside_a_branch_that_does_not_come_from_its_bound) {
  // x² = p + 1/2: back from p = 0 there is a fold, and no p = −1.
  Kept kept;
  const Diagram diagram = from_inside(scalar([](double x, const Vector& p) { return p[0] + 0.5 - x * x; }),
                                      std::sqrt(0.5), 0.0, kept);
  BOOST_REQUIRE_EQUAL(diagram.lost.size(), 1u);
  BOOST_TEST(diagram.lost[0].find("back from its start") != std::string::npos);
  BOOST_TEST(of_type(kept.points, PointType::fold).size() == 1u);
  BOOST_TEST(kept.points.back().p[0] == 1.0);
  Kept impatient;
  impatient.stop_at = 2;
  const Diagram stopped = from_inside(scalar([](double x, const Vector& p) { return p[0] + 0.5 - x * x; }),
                                      std::sqrt(0.5), 0.0, impatient);
  BOOST_TEST(stopped.stopped);
  BOOST_TEST(impatient.points.empty());
}

BOOST_AUTO_TEST_CASE(with_a_tangent_on_a_branch_point) {
  Options options;
  options.lower = -1.0;
  options.upper = 1.0;
  Walker walker(pitchfork(), vector({0.0, 0.0}), vector({0.0}), Tangent{vector({-1.0, 0.0}), 0.0}, options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_TEST(std::abs(points.back().x[0] + 1.0) < 1e-9);
}

BOOST_AUTO_TEST_CASE(what_is_no_solution_is_no_start) {
  Options options;
  Walker walker(scalar([](double x, const Vector& p) { return p[0] + x * x; }), vector({0.0}), vector({1.0}),
                options);
  BOOST_TEST(walk(walker).empty());
  BOOST_TEST(walker.end().lost());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_looked_for_is_said) {
  class Blind : public AlgebraicProblem {
   public:
    using AlgebraicProblem::AlgebraicProblem;
    int determinant_sign() override { return 0; }
    std::shared_ptr<Problem> clone() const override { return std::make_shared<Blind>(*this); }
  };
  auto problem = std::make_shared<Blind>(
      1, [](const Vector& x, const Vector& p) { return vector({-p[0] * x[0] + std::pow(x[0], 3)}); });
  problem->index_known = false;
  Options options;
  options.upper = 1.0;
  DiagramObserver silent;
  const Diagram diagram = trace_diagram(problem, vector({0.0}), vector({-1.0}), options, {}, silent);
  BOOST_REQUIRE_EQUAL(diagram.notes.size(), 1u);
  BOOST_TEST(diagram.notes[0].find("neither index nor determinant_sign") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
