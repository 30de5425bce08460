#include <boost/test/unit_test.hpp>
#include <cmath>

#include "algebraic_problem.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

// Spring against a stop: free x = p while the gap 1 - x is positive, then x = 1 held by a force f = p - 1 >=
// 0. The free state has one unknown, the touching one two (x, f).
std::shared_ptr<AlgebraicProblem> touching();

std::shared_ptr<AlgebraicProblem> free_spring() {
  auto problem = scalar([](double x, const Vector& p) { return x - std::sin(p[0]) * 1.5; });
  problem->events_of = [](const Vector& x, const Vector& p) {
    return std::vector<EventFunction>{{"far", 10.0 - p[0]}, {"gap", 1.0 - x[0]}};
  };
  problem->transition_of = [](std::size_t which, const Vector& x,
                              const Vector&) -> std::optional<Transition> {
    if (which != 1) return std::nullopt;
    return Transition{touching(), vector({x[0], 0.0}), "free", "touch", {}};
  };
  return problem;
}

std::shared_ptr<AlgebraicProblem> touching() {
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({x[0] + x[1] - std::sin(p[0]) * 1.5, x[0] - 1.0});
  });
  problem->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"force", x[1]}};
  };
  problem->transition_of = [](std::size_t, const Vector& x, const Vector&) -> std::optional<Transition> {
    return Transition{free_spring(), vector({x[0]}), "touch", "free", {}};
  };
  return problem;
}

BOOST_AUTO_TEST_SUITE(events)

BOOST_AUTO_TEST_CASE(branch_goes_through_events_with_a_change_of_size) {
  Options options;
  options.target = 3.1;
  Walker walker(free_spring(), vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  const auto events = of_type(points, PointType::event);
  BOOST_REQUIRE_EQUAL(events.size(), 2u);
  const double at = std::asin(1.0 / 1.5);
  BOOST_TEST(std::abs(events[0].p[0] - at) < 2e-10);
  BOOST_TEST(std::abs(events[1].p[0] - (M_PI - at)) < 2e-10);
  BOOST_TEST(events[0].precision < 2e-10);
  BOOST_TEST(events[0].event == "gap");
  BOOST_TEST(events[1].event == "force");
  BOOST_TEST(events[0].before == "free");
  BOOST_TEST(events[0].after == "touch");
  BOOST_TEST(events[0].x.size() == 1);
  BOOST_TEST(events[0].next_x.size() == 2);
  BOOST_TEST((walker.end().kind == End::Kind::target));
  BOOST_TEST(points.back().p[0] == 3.1);
  // Nowhere is the gap or the force negative beyond the location's tolerance.
  for (const Point& point : points) {
    for (const auto& event : point.problem->events(point.x, point.p)) BOOST_TEST(event.value > -1e-9);
  }
  BOOST_TEST(of_type(points, PointType::branch_point).empty());
}

// What follows the event is not known, what holds a little further on is: the walk goes on there, and says how far that is.
BOOST_AUTO_TEST_CASE(an_event_that_cannot_be_passed_is_leapt_over) {
  const auto spring = free_spring();
  int asked = 0;
  spring->transition_of = [](std::size_t, const Vector&, const Vector&) -> std::optional<Transition> {
    return std::nullopt;
  };
  // Nearer than 0.01 to the event nothing is found.
  const double at = std::asin(1.0 / 1.5);
  spring->resettled_of = [&](const Vector& x, const Vector& p) -> std::optional<Transition> {
    ++asked;
    if (p[0] < at + 0.01) return std::nullopt;
    BOOST_TEST(x[0] > 1.0);  // a guess beyond the event
    return Transition{touching(), vector({1.0, 1.5 * std::sin(p[0]) - 1.0}), "free", "touch", p};
  };
  Options options;
  options.target = 1.5;
  Walker walker(spring, vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  const auto events = of_type(points, PointType::event);
  BOOST_REQUIRE_EQUAL(events.size(), 1u);
  BOOST_TEST(asked > 1);
  BOOST_TEST(std::abs(events[0].p[0] - at) < 2e-10);
  BOOST_TEST(events[0].precision == events[0].next_p[0] - events[0].p[0]);
  BOOST_TEST(events[0].precision >= 0.01 - 2e-10);
  BOOST_TEST(events[0].after == "touch");
  BOOST_TEST((walker.end().kind == End::Kind::target));
  BOOST_TEST(std::abs(points.back().x[1] - (1.5 * std::sin(1.5) - 1.0)) < 1e-10);
}

// p = 1 − x² comes back behind its turn as the mirror image of what is before it: |x| is alike at both ends of the step.
BOOST_AUTO_TEST_CASE(an_event_between_mirror_images_is_not_jumped_over) {
  auto problem = scalar([](double x, const Vector& p) { return p[0] - 1.0 + x * x; });
  problem->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"distance", std::abs(x[0]) - 0.05}};
  };
  problem->transition_of = [](std::size_t, const Vector&, const Vector&) -> std::optional<Transition> {
    return Transition{nullptr, {}, "apart", "touch", {}};
  };
  Options options;
  options.step = 0.4;
  Walker walker(problem, vector({-0.2}), vector({0.96}), options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::event));
  BOOST_TEST(std::abs(points.back().x[0] + 0.05) < 1e-9);
}

BOOST_AUTO_TEST_CASE(several_events_in_one_step_come_in_order) {
  auto problem = scalar([](double x, const Vector& p) { return x - p[0]; });
  problem->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"late", 0.5 - x[0]},
                                      {"early", std::cos(20.0 * x[0]) + 0.2 - 10.0 * x[0]}};
  };
  std::vector<std::size_t> seen;
  problem->transition_of = [&](std::size_t which, const Vector&, const Vector&) -> std::optional<Transition> {
    seen.push_back(which);
    return Transition{nullptr, {}, "a", "b", {}};
  };
  Options options;
  options.step = 1.0, options.step_max = 1.0;
  Walker walker(problem, vector({-0.1}), vector({-0.1}), options);
  const auto points = walk(walker);
  BOOST_REQUIRE_EQUAL(seen.size(), 1u);
  BOOST_TEST(seen[0] == 1u);
  BOOST_TEST((walker.end().kind == End::Kind::event));
  BOOST_TEST(walker.end().reason == "event early ends the branch");
  BOOST_TEST((points.back().type == PointType::event));
  const double x = points.back().x[0];
  BOOST_TEST(std::abs(std::cos(20.0 * x) + 0.2 - 10.0 * x) < 1e-8);
}

// Negative from 0.45 to 0.55 only, between two points of the walk.
BOOST_AUTO_TEST_CASE(an_event_that_is_over_within_a_step_is_seen) {
  const auto dip = [](double x) { return std::pow(x - 0.5, 2) - 0.0025 + 0.1 * std::pow(x - 0.5, 3); };
  for (const double step : {0.11, 0.2, 0.3}) {
    auto problem = scalar([](double x, const Vector& p) { return x - p[0]; });
    problem->events_of = [&](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"later", 0.52 - x[0]}, {"dip", dip(x[0])}};
    };
    problem->transition_of = [](std::size_t, const Vector&, const Vector&) {
      return std::optional(Transition{nullptr, {}, "a", "b", {}});
    };
    Options options;
    options.step = options.step_max = step * std::sqrt(2.0);  // x and p go equally far
    options.target = 2.0;
    Walker walker(problem, vector({-0.4}), vector({-0.4}), options);
    const auto points = walk(walker);
    BOOST_TEST_CONTEXT("step " << step) {
      BOOST_TEST(walker.end().reason == "event dip ends the branch");
      BOOST_TEST(std::abs(dip(points.back().x[0])) < 1e-9);
      BOOST_TEST(points.back().x[0] < 0.5);
    }
  }
}

BOOST_AUTO_TEST_CASE(unknown_continuation_is_a_lost_branch) {
  auto problem = free_spring();
  problem->transition_of = {};
  Options options;
  options.target = 3.1;
  Walker walker(problem, vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  BOOST_TEST(walker.end().lost());
  BOOST_TEST(walker.end().reason == "event gap: no continuation is known");
  BOOST_TEST((points.back().type == PointType::event));
}

BOOST_AUTO_TEST_CASE(branch_may_turn_back_at_an_event) {
  // Beyond x = 0.5 the law changes to p = 1 - x: the branch goes on with p falling (a corner, not a fold).
  auto first = scalar([](double x, const Vector& p) { return x - p[0]; });
  first->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"first", 0.5 - x[0]}};
  };
  auto second = scalar([](double x, const Vector& p) { return x - 1.0 + p[0]; });
  second->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"second", x[0] - 0.5}};
  };
  first->transition_of = [second](std::size_t, const Vector& x, const Vector&) {
    return std::optional(Transition{second, x, "first", "second", {}});
  };
  Options options;
  options.lower = -1.0;
  options.upper = 2.0;
  Walker walker(first, vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  BOOST_TEST(of_type(points, PointType::event).size() == 1u);
  BOOST_TEST(points.back().p[0] == -1.0);
  BOOST_TEST(std::abs(points.back().x[0] - 2.0) < 1e-10);
}

// A walk that begins at an event, where the function that vanishes is rounding of either sign, leaves it to the valid side.
BOOST_AUTO_TEST_CASE(a_walk_may_begin_at_an_event) {
  for (const double rounding : {1e-10, -1e-10, 0.0}) {
    auto problem = scalar([](double x, const Vector& p) { return x - p[0]; });
    problem->events_of = [&](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"force", x[0] - 0.5 + rounding}};
    };
    problem->transition_of = [](std::size_t, const Vector&, const Vector&) {
      return std::optional(Transition{nullptr, {}, "contact", "none", {}});
    };
    Options options;
    options.lower = 0.0;
    options.upper = 1.0;
    for (const int direction : {1, -1}) {
      options.direction = direction;
      Walker walker(problem, vector({0.5}), vector({0.5}), options);
      const auto points = walk(walker);
      BOOST_TEST_CONTEXT("rounding " << rounding << ", direction " << direction) {
        BOOST_TEST((walker.end().kind == (direction > 0 ? End::Kind::bound : End::Kind::event)));
        BOOST_TEST(std::abs(points.back().p[0] - (direction > 0 ? 1.0 : 0.5)) < 1e-9);
      }
    }
  }
}

// Where a force f vanishes its place y costs nothing: J is singular, the branch y = 0 is not.
BOOST_AUTO_TEST_CASE(a_walk_may_begin_where_a_force_vanishes) {
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({x[0] - p[0] + 0.5, x[0] * x[1]});
  });
  problem->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"force", x[0]}};
  };
  problem->transition_of = [](std::size_t, const Vector&, const Vector&) {
    return std::optional(Transition{nullptr, {}, "contact", "none", {}});
  };
  Options options;
  options.lower = 0.0;
  options.upper = options.target = 1.0;
  Walker walker(problem, vector({0.0, 0.0}), vector({0.5}), options);
  const auto points = walk(walker);
  BOOST_TEST((walker.end().kind == End::Kind::target));
  BOOST_TEST(points.back().p[0] == 1.0);
  BOOST_TEST(std::abs(points.back().x[0] - 0.5) < 1e-12);
  BOOST_TEST(std::abs(points.back().x[1]) < 1e-12);
}

// An event is known to its precision: a stop value within that is met there, from both sides, and not passed by.
BOOST_AUTO_TEST_CASE(a_stop_value_at_an_event_is_met) {
  for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8}) {
    auto first = scalar([](double x, const Vector& p) { return x - p[0]; });
    first->events_of = [](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"first", 0.5 - x[0]}};
    };
    auto second = scalar([](double x, const Vector& p) { return x - 2.0 * p[0] + 0.5; });
    second->events_of = [](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"second", x[0] - 0.5}};
    };
    first->transition_of = [second](std::size_t, const Vector& x, const Vector&) {
      return std::optional(Transition{second, x, "first", "second", {}});
    };
    Options options;
    options.target = options.upper = 0.5 + off;
    options.lower = 0.0;
    Walker walker(first, vector({0.0}), vector({0.0}), options);
    const auto points = walk(walker);
    BOOST_TEST_CONTEXT("beside the event by " << off) {
      BOOST_TEST((walker.end().kind == End::Kind::target));
      BOOST_TEST(std::abs(points.back().p[0] - options.target) <= 1e-14);
    }
  }
}

// Beyond x = p = 1/2 the law is p = 1/2 + (x - 1/2)², and the branch goes on at x = 0.7, p = 0.54.
BOOST_AUTO_TEST_CASE(a_stop_value_before_the_branch_goes_on_is_met) {
  for (const double least : {0.5, 0.65}) {  // below it the second law says nothing
    auto first = scalar([](double x, const Vector& p) { return x - p[0]; });
    first->events_of = [](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"first", 0.5 - x[0]}};
    };
    auto second = scalar([least](double x, const Vector& p) {
      if (x < least) throw std::domain_error("undefined");
      return std::pow(x - 0.5, 2) + 0.5 - p[0];
    });
    second->events_of = [](const Vector& x, const Vector&) {
      return std::vector<EventFunction>{{"second", x[0] - 0.5}};
    };
    first->transition_of = [second](std::size_t, const Vector&, const Vector&) {
      return std::optional(Transition{second, vector({0.7}), "first", "second", vector({0.54})});
    };
    Options options;
    options.target = 0.51;
    Walker walker(first, vector({0.0}), vector({0.0}), options);
    const auto points = walk(walker);
    BOOST_TEST_CONTEXT("the second law begins at " << least) {
      if (least > 0.6) {
        BOOST_TEST(walker.end().lost());
        continue;
      }
      BOOST_TEST((walker.end().kind == End::Kind::target));
      BOOST_TEST(points.back().p[0] == 0.51);
      BOOST_TEST(std::abs(points.back().x[0] - 0.6) < 1e-9);
      BOOST_TEST(of_type(points, PointType::event).size() == 1u);
    }
  }
}

BOOST_AUTO_TEST_CASE(event_with_no_valid_side_is_lost) {
  auto first = free_spring();
  first->transition_of = [](std::size_t, const Vector& x, const Vector&) {
    auto bad = scalar([](double y, const Vector& p) { return y - p[0]; });
    bad->events_of = [](const Vector&, const Vector&) { return std::vector<EventFunction>{{"never", -1.0}}; };
    return std::optional(Transition{bad, x, "a", "b", {}});
  };
  Options options;
  options.target = 3.0;
  Walker walker(first, vector({0.0}), vector({0.0}), options);
  walk(walker);
  BOOST_TEST(walker.end().lost());
  BOOST_TEST(walker.end().reason.find("not valid in either direction") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(event_at_the_edge_of_the_domain) {
  // A length 1 - x² that F cannot have negative: every trial step beyond the event fails.
  auto first = scalar([](double x, const Vector& p) {
    if (x > 0.7) throw std::domain_error("negative length");
    return x - p[0];
  });
  first->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"other", 5.0}, {"length", 0.49 - x[0] * x[0]}};
  };
  first->transition_of = [](std::size_t which, const Vector& x, const Vector&) -> std::optional<Transition> {
    if (which != 1) return std::nullopt;
    return Transition{
        scalar([](double y, const Vector& p) { return y - 0.7 - 2.0 * (p[0] - 0.7); }), x, "a", "b", {}};
  };
  Options options;
  options.target = 1.0;
  Walker walker(first, vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  const auto events = of_type(points, PointType::event);
  BOOST_REQUIRE_EQUAL(events.size(), 1u);
  BOOST_TEST(std::abs(events[0].p[0] - 0.7) < 1e-5);
  BOOST_TEST(!events[0].note.empty());
  BOOST_TEST(points.back().p[0] == 1.0);
  BOOST_TEST(std::abs(points.back().x[0] - 1.3) < 1e-10);
}

BOOST_AUTO_TEST_CASE(mirror_images_vanish_together) {
  // Two gaps close at the same place; each transition closes one of them.
  std::function<std::shared_ptr<AlgebraicProblem>(bool, bool)> make = [&make](bool left, bool right) {
    const Eigen::Index n = 1 + left + right;
    auto problem = std::make_shared<AlgebraicProblem>(n, [n](const Vector& x, const Vector& p) {
      Vector f = Vector::Zero(n);  // x held at 1 by each closed gap in turn, forces share p - 1
      f[0] = n == 1 ? x[0] - p[0] : x[0] - 1.0;
      for (Eigen::Index i = 1; i < n; ++i) f[i] = x[i] - (p[0] - 1.0) / static_cast<double>(n - 1);
      return f;
    });
    problem->events_of = [left, right](const Vector& x, const Vector& p) {
      std::vector<EventFunction> events;
      Eigen::Index k = 1;
      events.push_back(left ? EventFunction{"force left", x[k++]} : EventFunction{"gap left", 1.0 - p[0]});
      events.push_back(right ? EventFunction{"force right", x[k++]} : EventFunction{"gap right", 1.0 - p[0]});
      return events;
    };
    problem->transition_of = [left, right, &make](std::size_t which, const Vector& x, const Vector&) {
      Vector guess = Vector::Zero(x.size() + 1);
      guess[0] = 1.0;
      return std::optional(Transition{make(left || which == 0, right || which == 1), guess, "", "", {}});
    };
    return problem;
  };
  Options options;
  options.target = 2.0;
  Walker walker(make(false, false), vector({0.0}), vector({0.0}), options);
  const auto points = walk(walker);
  const auto events = of_type(points, PointType::event);
  BOOST_REQUIRE_EQUAL(events.size(), 2u);
  for (const Point& event : events) BOOST_TEST(std::abs(event.p[0] - 1.0) < 2e-10);
  BOOST_TEST(events[0].event != events[1].event);
  BOOST_TEST(points.back().p[0] == 2.0);
  BOOST_TEST(points.back().x.size() == 3);
}

// A function that is small, and stays so, is no image of the one that vanishes: it excuses no state of the wrong side.
BOOST_AUTO_TEST_CASE(what_is_merely_small_does_not_vanish_together) {
  auto free = scalar([](double x, const Vector& p) { return x - p[0]; });
  free->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"gap", 1.0 - x[0]}, {"weak", 1e-8}};
  };
  free->transition_of = [](std::size_t, const Vector& x, const Vector&) {
    // Held at 1 by a force that pushes only below p = 1: the branch turns back there.
    auto held = std::make_shared<AlgebraicProblem>(2, [](const Vector& y, const Vector& p) {
      return vector({y[0] - 1.0, y[1] - (1.0 - p[0])});
    });
    held->events_of = [](const Vector& y, const Vector&) {
      return std::vector<EventFunction>{{"force", y[1]}, {"weak", 1e-8}};
    };
    return std::optional(Transition{held, vector({x[0], 0.0}), "free", "held", {}});
  };
  Options options;
  options.lower = 0.0;
  options.upper = 2.0;
  Walker walker(free, vector({0.5}), vector({0.5}), options);
  const auto points = walk(walker);
  BOOST_REQUIRE_EQUAL(of_type(points, PointType::event).size(), 1u);
  BOOST_TEST(points.back().p[0] == 0.0);
  BOOST_TEST(points.back().x.size() == 2);
}

BOOST_AUTO_TEST_CASE(ping_pong_is_not_endless) {
  // Each problem claims to end where the other begins, on the same side.
  std::shared_ptr<AlgebraicProblem> a, b;
  const auto law = [](double x, const Vector& p) { return x - p[0]; };
  a = scalar(law);
  b = scalar(law);
  a->events_of = [](const Vector& x, const Vector&) { return std::vector<EventFunction>{{"a", 0.5 - x[0]}}; };
  b->events_of = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"b", std::max(-1.0, (0.5 - x[0]) * (x[0] - 0.5) * 1e12)}};
  };
  const auto copy = [](const std::shared_ptr<AlgebraicProblem>& problem) {
    return std::make_shared<AlgebraicProblem>(*problem);
  };
  b->transition_of = [=](std::size_t, const Vector& x, const Vector&) {
    return std::optional(Transition{copy(a), x, "b", "a", {}});
  };
  a->transition_of = [=](std::size_t, const Vector& x, const Vector&) {
    return std::optional(Transition{copy(b), x, "a", "b", {}});
  };
  Options options;
  options.target = 3.0;
  options.max_points = 200;
  Walker walker(a, vector({0.0}), vector({0.0}), options);
  BOOST_TEST(walk(walker).size() < 250u);
  BOOST_TEST(static_cast<bool>(walker.end()));
  a->transition_of = b->transition_of = {};  // they own each other
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
