// Branch points that the problem followed, posed on symmetric states, does not see.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/checkpoint.hpp"
#include "continuation/diagram.hpp"
#include "walk.hpp"

namespace continuation::testing {
namespace {

// V(a, b; p) = (a − p)²/2 + (1 − a) b²/2 + b⁴/4 is even in b. On b = 0 the branch is a = p; the mode b loses stability at
// p = 1, where the arms b² = 2 (p − 1), a = 2 p − 1 leave it.
std::shared_ptr<AlgebraicProblem> whole() {
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({x[0] - p[0] - 0.5 * x[1] * x[1], (1.0 - x[0]) * x[1] + x[1] * x[1] * x[1]});
  });
  problem->fingerprint_of = [](const Vector& x, const Vector&) { return vector({x[0], std::abs(x[1])}); };
  return problem;
}

/// The same on b = 0.
class Symmetric : public AlgebraicProblem {
 public:
  Symmetric() : AlgebraicProblem(1, [](const Vector& x, const Vector& p) { return vector({x[0] - p[0]}); }) {
    fingerprint_of = [](const Vector& x, const Vector&) { return vector({x[0], 0.0}); };
  }
  int breaking_index(const Vector& x, const Vector&) override { return x[0] > 1.0 ? 1 : 0; }
  std::optional<Unrestricted> unrestricted(const Vector& x, const Vector&) override {
    if (!has_whole) return std::nullopt;
    return Unrestricted{whole(), vector({x[0], 0.0})};
  }
  std::shared_ptr<Problem> clone() const override { return std::make_shared<Symmetric>(*this); }
  bool has_whole = true;
};

Options upward(double step) {
  Options options;
  options.step = options.step_max = step;
  options.target = options.upper = 2.0;
  options.lower = 0.0;
  return options;
}

BOOST_AUTO_TEST_SUITE(symmetry_breaking)

BOOST_AUTO_TEST_CASE(the_point_is_located_on_the_whole_problem) {
  for (const double step : {0.03, 0.1, 0.5}) {
    Walker walker(std::make_shared<Symmetric>(), vector({0.0}), vector({0.0}), upward(step));
    const std::vector<Point> found = of_type(walk(walker), PointType::branch_point);
    BOOST_TEST_REQUIRE(found.size() == 1u);
    const Point& point = found.front();
    BOOST_TEST(std::abs(point.p[0] - 1.0) < 1e-10);  // Options::location_tolerance
    BOOST_TEST(point.precision < 1e-10);
    BOOST_TEST(point.problem->size() == 2);
    BOOST_TEST_REQUIRE(point.branch_point != nullptr);
    BOOST_TEST(point.branch_point->polished);
    BOOST_TEST(std::abs(point.branch_point->null.right(1, 0)) > 0.99);  // the mode is b
    BOOST_TEST(point.index == 0);
    BOOST_TEST(point.index_after == 1);
  }
}

BOOST_AUTO_TEST_CASE(its_arms_are_followed_there_and_mirror_images_named_once) {
  struct Watch : DiagramObserver {
    void on_point(const Branch& branch, const Point& point) override {
      if (branch.id != 1) return;
      last = point;
      BOOST_TEST(point.x[0] == 2.0 * point.p[0] - 1.0, boost::test_tools::tolerance(1e-9));
    }
    Point last;
  } watch;
  const Diagram diagram =
      trace_diagram(std::make_shared<Symmetric>(), vector({0.0}), vector({0.0}), upward(0.1), {}, watch);
  BOOST_TEST_REQUIRE(diagram.branches.size() == 2u);
  BOOST_TEST(diagram.branches[1].origin == "B1");
  BOOST_TEST(diagram.branches[1].count == 2);
  BOOST_TEST(diagram.lost.empty());
  BOOST_TEST(watch.last.p[0] == 2.0);
  BOOST_TEST(std::abs(watch.last.x[1]) == std::sqrt(2.0), boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(without_the_whole_problem_it_is_bracketed_and_said) {
  auto problem = std::make_shared<Symmetric>();
  problem->has_whole = false;
  Walker walker(problem, vector({0.0}), vector({0.0}), upward(0.1));
  const std::vector<Point> found = of_type(walk(walker), PointType::branch_point);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(std::abs(found.front().p[0] - 1.0) < 1e-9);
  BOOST_TEST(found.front().note.find("not polished") == 0u, found.front().note);
  BOOST_TEST(found.front().branch_point == nullptr);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace continuation::testing
