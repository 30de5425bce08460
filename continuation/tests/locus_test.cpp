#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "continuation/locus.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

std::vector<LocusPoint> walk_locus(LocusWalker& walker) {
  std::vector<LocusPoint> points;
  while (auto point = walker.step()) points.push_back(std::move(*point));
  return points;
}

Point special(std::shared_ptr<Problem> problem, Vector x, Vector p, PointType type, int direction = 1,
              double lower = -3.0, double upper = 3.0) {
  Options options;
  options.lower = lower;
  options.upper = upper;
  options.direction = direction;
  Walker walker(std::move(problem), std::move(x), std::move(p), options);
  const auto found = of_type(walk(walker), type);
  BOOST_REQUIRE(!found.empty());
  return found[0];
}

BOOST_AUTO_TEST_SUITE(loci)

BOOST_AUTO_TEST_CASE(fold_locus_goes_through_the_cusp) {
  // x³ - μ x + λ = 0, p = (λ, μ): folds at 27 λ² = 4 μ³, cusp at the origin. Embedded in two unknowns.
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({x[0] * x[0] * x[0] - p[1] * x[0] + p[0] + x[1], x[1] - 0.5 * x[1] * x[0]});
  });
  const Point fold = special(problem, vector({-1.8, 0.0}), vector({1.8 * 1.8 * 1.8 - 1.8, 1.0}),
                             PointType::fold, -1, -6.0, 6.0);
  LocusOptions options;
  options.options.direction = -1;
  options.options.lower = -1.0;
  options.options.upper = 1.0;
  options.second_lower = -1.0;
  options.second_upper = 1.5;
  LocusWalker walker(fold, options);
  const auto points = walk_locus(walker);
  BOOST_TEST(points.size() > 8u);
  int cusps = 0;
  for (const LocusPoint& point : points) {
    const double l = point.p[0], m = point.p[1];
    BOOST_TEST(std::abs(27.0 * l * l - 4.0 * m * m * m) < 1e-9);
    BOOST_TEST(std::abs(3.0 * point.x[0] * point.x[0] - m) < 1e-8);
    if (point.type == LocusPoint::Type::degenerate) {
      ++cusps;
      BOOST_TEST(point.note == "cusp");
      BOOST_TEST(std::abs(m) < 1e-8);
      BOOST_TEST(std::abs(point.x[0]) < 1e-5);
    }
  }
  BOOST_TEST(cusps == 1);
  BOOST_TEST(points.front().p[0] * points.back().p[0] < 0.0);  // from one arm of the cusp to the other
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_TEST((std::abs(points.back().p[0]) == 1.0 || points.back().p[1] == 1.5));
}

BOOST_AUTO_TEST_CASE(pitchfork_locus) {
  // -(λ - μ²) x + x³ = 0 beside a second unknown w = λ: branch points at λ = μ².
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({-(p[0] - p[1] * p[1]) * x[0] + x[0] * x[0] * x[0], x[1] - std::sin(p[0])});
  });
  const Point point =
      special(problem, vector({0.0, std::sin(-1.0)}), vector({-1.0, 0.5}), PointType::branch_point);
  LocusOptions options;
  options.options.direction = -1;
  options.second_lower = -1.2;
  LocusWalker walker(point, options);
  const auto points = walk_locus(walker);
  BOOST_TEST((walker.end().kind == End::Kind::bound));
  BOOST_TEST(points.back().p[1] == -1.2);
  for (const LocusPoint& p : points) {
    BOOST_TEST(std::abs(p.p[0] - p.p[1] * p.p[1]) < 1e-9);
    BOOST_TEST(std::abs(p.x[0]) < 1e-8);
    BOOST_TEST((p.type != LocusPoint::Type::degenerate));
  }
}

BOOST_AUTO_TEST_CASE(transcritical_locus_off_the_axes) {
  // (x - μ)(λ - sin μ - (x - μ)): the crossing moves in the direction of the kernel.
  auto problem = scalar([](double x, const Vector& p) {
    const double u = x - p[1];
    return u * (p[0] - std::sin(p[1]) - u);
  });
  const Point point = special(problem, vector({0.3}), vector({-1.0, 0.3}), PointType::branch_point);
  LocusOptions options;
  options.second_upper = 2.0;
  LocusWalker walker(point, options);
  const auto points = walk_locus(walker);
  BOOST_TEST(points.back().p[1] == 2.0);
  for (const LocusPoint& p : points) {
    BOOST_TEST(std::abs(p.p[0] - std::sin(p.p[1])) < 1e-9);
    BOOST_TEST(std::abs(p.x[0] - p.p[1]) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(crossing_that_comes_apart_ends_its_locus) {
  // -λ x + x³ + μ = 0: a pitchfork at μ = 0 only.
  auto problem = scalar([](double x, const Vector& p) { return -p[0] * x + x * x * x + p[1]; });
  const Point point = special(problem, vector({0.0}), vector({-1.0, 0.0}), PointType::branch_point);
  LocusOptions options;
  LocusWalker walker(point, options);
  walk_locus(walker);
  BOOST_TEST(walker.end().reason.find("comes apart") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(double_branch_point_locus) {
  auto problem = std::make_shared<AlgebraicProblem>(3, [](const Vector& x, const Vector& p) {
    const double a = x[0], b = x[1], r = a * a + b * b, l = p[0] - std::cos(p[1]);
    return vector({-l * a + r * a, -l * b + r * b, x[2] - p[0] * p[1]});
  });
  const Point point =
      special(problem, vector({0.0, 0.0, -1.0}), vector({-1.0, 1.0}), PointType::branch_point, 1, -2.0, 2.0);
  BOOST_TEST(point.multiplicity == 2);
  LocusOptions options;
  options.second_upper = 2.0;
  LocusWalker walker(point, options);
  const auto points = walk_locus(walker);
  BOOST_TEST(points.back().p[1] == 2.0);
  for (const LocusPoint& p : points) BOOST_TEST(std::abs(p.p[0] - std::cos(p.p[1])) < 1e-9);
}

std::shared_ptr<AlgebraicProblem> gap_problem() {
  // x = λ + μ²; the gap 1 - x closes on λ = 1 - μ².
  auto problem = scalar([](double x, const Vector& p) { return x - p[0] - p[1] * p[1]; });
  problem->events_of = [](const Vector& x, const Vector& p) {
    return std::vector<EventFunction>{{"gap", 1.0 - x[0]}, {"wall", 1.5 - p[1]}};
  };
  return problem;
}

BOOST_AUTO_TEST_CASE(event_locus_ends_at_another_event) {
  const Point event = special(gap_problem(), vector({0.0}), vector({0.0, 0.0}), PointType::event);
  LocusOptions options;
  LocusWalker walker(event, options);
  const auto points = walk_locus(walker);
  for (const LocusPoint& p : points) BOOST_TEST(std::abs(p.p[0] - 1.0 + p.p[1] * p.p[1]) < 1e-9);
  BOOST_TEST((walker.end().kind == End::Kind::event));
  BOOST_TEST(walker.end().reason == "event wall: no continuation is known");
  BOOST_TEST((points.back().type == LocusPoint::Type::event));
  BOOST_TEST(std::abs(points.back().p[1] - 1.5) < 1e-9);
}

BOOST_AUTO_TEST_CASE(event_locus_goes_through_another_event) {
  auto problem = gap_problem();
  problem->transition_of = [](std::size_t, const Vector& x, const Vector&) {
    auto beyond = std::make_shared<AlgebraicProblem>(2, [](const Vector& y, const Vector& p) {
      return vector({y[0] - p[0] - p[1] * p[1] + y[1], y[1] - (p[1] - 1.5)});
    });
    beyond->events_of = [](const Vector& y, const Vector&) {
      return std::vector<EventFunction>{{"gap", 1.0 - y[0]}, {"force", y[1]}};
    };
    return std::optional(Transition{beyond, vector({x[0], 0.0}), "off", "on", {}});
  };
  const Point event = special(gap_problem(), vector({0.0}), vector({0.0, 0.0}), PointType::event);
  Point start = event;
  start.problem = problem;
  LocusOptions options;
  options.second_upper = 2.0;
  LocusWalker walker(start, options);
  const auto points = walk_locus(walker);
  int passed = 0;
  for (const LocusPoint& p : points) {
    const double jump = std::max(0.0, p.p[1] - 1.5);
    BOOST_TEST(std::abs(p.p[0] - 1.0 + p.p[1] * p.p[1] - jump) < 1e-9);
    passed += p.type == LocusPoint::Type::event;
  }
  BOOST_TEST(passed == 1);
  BOOST_TEST(points.back().p[1] == 2.0);
  BOOST_TEST(points.back().x.size() == 2);
}

BOOST_AUTO_TEST_CASE(closed_locus) {
  // Event on the circle λ² + μ² = 1.
  auto problem = scalar([](double x, const Vector& p) { return x - p[0]; });
  problem->events_of = [](const Vector& x, const Vector& p) {
    return std::vector<EventFunction>{{"ring", 1.0 - x[0] * x[0] - p[1] * p[1]}};
  };
  const Point event = special(problem, vector({0.0}), vector({0.0, 0.2}), PointType::event);
  LocusWalker walker(event, LocusOptions{});
  const auto points = walk_locus(walker);
  BOOST_TEST((walker.end().kind == End::Kind::closed));
  int tangent = 0;
  for (const LocusPoint& p : points) {
    BOOST_TEST(std::abs(p.p[0] * p.p[0] + p.p[1] * p.p[1] - 1.0) < 1e-9);
    if (p.type == LocusPoint::Type::degenerate) {
      ++tangent;
      BOOST_TEST(std::abs(std::abs(p.p[1]) - 1.0) < 1e-9);
    }
  }
  BOOST_TEST(tangent == 2);
}

BOOST_AUTO_TEST_CASE(locus_failures_have_reasons) {
  auto problem = scalar([](double x, const Vector& p) {
    if (p[1] > 0.5) throw std::domain_error("mu > 0.5");
    return p[0] - 1.0 + x * x + p[1];
  });
  const Point fold = special(problem, vector({-1.0}), vector({0.0, 0.0}), PointType::fold);
  LocusWalker walker(fold, LocusOptions{});
  const auto points = walk_locus(walker);
  BOOST_TEST(walker.end().lost());
  BOOST_TEST(walker.end().reason.find("mu > 0.5") != std::string::npos);
  BOOST_TEST(points.back().p[1] > 0.4999);
  Point wrong = fold;
  wrong.type = PointType::regular;
  BOOST_CHECK_THROW(LocusWalker(wrong, LocusOptions{}), std::invalid_argument);
  LocusOptions same;
  same.second = 0;
  BOOST_CHECK_THROW(LocusWalker(fold, same), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
