#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "algebraic_problem.hpp"
#include "continuation/checkpoint.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

/// A diagram to be left and gone on with; problems are told apart by their size.
struct Case {
  std::vector<std::shared_ptr<AlgebraicProblem>> problems;  ///< the first one starts
  Vector x, p;
  Options options;
  DiagramOptions limits;

  ProblemCodec codec() const {
    return {[](const Problem& problem) { return nlohmann::json(problem.size()); },
            [this](const nlohmann::json& size) -> std::shared_ptr<Problem> {
              for (const auto& problem : problems)
                if (problem->size() == size) return problem->clone();
              throw std::runtime_error("no such problem");
            }};
  }
};

struct Killed {};

/// Notes everything reported, to the last bit; is killed at the rest of a given number, or asks for a stop there.
class Log : public DiagramObserver {
 public:
  explicit Log(const Case& of) : case_(of) {}
  std::vector<std::string> lines;
  std::vector<std::size_t> lines_at_rest;
  std::vector<std::uint8_t> stored;  ///< the state at the last rest asked for
  int kill_at = -1, stop_after = 1 << 30;

  void on_branch_start(const Branch& b) override { lines.push_back("start " + b.origin + number(b.depth)); }
  void on_point(const Branch& b, const Point& point) override {
    std::string line = point.label + " " + name(point.type) + number(b.id) + number(point.ds) +
                       number(point.path_length) + number(point.index) + number(point.newton_iterations);
    for (const double value : point.x) line += number(value);
    for (const double value : point.p) line += number(value);
    lines.push_back(line);
  }
  void on_branch_end(const Branch& b) override { lines.push_back("end " + b.end.reason + number(b.points)); }
  bool should_stop() override { return static_cast<int>(lines_at_rest.size()) >= stop_after; }
  void on_rest(const DiagramState& state) override {
    lines_at_rest.push_back(lines.size());
    const bool kill = static_cast<int>(lines_at_rest.size()) == kill_at;
    if (kill || should_stop()) stored = nlohmann::json::to_cbor(encode(state, case_.codec()));
    if (kill) throw Killed();
  }

 private:
  static std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, " %a", value);
    return text;
  }
  const Case& case_;
};

DiagramState restored(const Case& of, const std::vector<std::uint8_t>& bytes) {
  return decode(nlohmann::json::from_cbor(bytes), of.options, of.codec());
}

/// Kills the diagram at every rest, goes on from the stored bytes alone, and expects what a whole run reports.
void check_every_rest(const Case& of) {
  const auto start = [&](Log& log) {
    return trace_diagram(of.problems[0]->clone(), of.x, of.p, of.options, of.limits, log);
  };
  Log whole(of);
  const Diagram diagram = start(whole);
  BOOST_REQUIRE(whole.lines_at_rest.size() > 10u);
  for (int kill_at = 1; kill_at <= static_cast<int>(whole.lines_at_rest.size()); ++kill_at) {
    BOOST_TEST_CONTEXT("killed at rest " << kill_at) {
      Log first(of);
      first.kill_at = kill_at;
      BOOST_CHECK_THROW(start(first), Killed);
      Log second(of);
      const Diagram resumed = resume_diagram(restored(of, first.stored), of.options, of.limits, second);
      std::vector<std::string> lines(whole.lines.begin(),
                                     whole.lines.begin() + whole.lines_at_rest[kill_at - 1]);
      BOOST_TEST(first.lines == lines, boost::test_tools::per_element());
      lines.insert(lines.end(), second.lines.begin(), second.lines.end());
      BOOST_REQUIRE(lines == whole.lines);
      BOOST_TEST(resumed.lost == diagram.lost, boost::test_tools::per_element());
      BOOST_TEST(resumed.branches.size() == diagram.branches.size());
      BOOST_TEST(resumed.specials.size() == diagram.specials.size());
    }
  }
}

Options coarse_between(double lower, double upper) {
  Options options;
  options.lower = lower;
  options.upper = upper;
  options.step = 0.07;
  return options;
}

Vector sizes(const Vector& x, const Vector&) { return x.cwiseAbs(); }

/// Two pitchforks in series: y branches off x = √p at p = 0.5 and off x = 0.
Case two_pitchforks() {
  auto problem = std::make_shared<AlgebraicProblem>(2, [](const Vector& x, const Vector& p) {
    return vector({-p[0] * x[0] + std::pow(x[0], 3), -(x[0] * x[0] - 0.5) * x[1] + std::pow(x[1], 3)});
  });
  problem->fingerprint_of = sizes;
  return {{problem}, vector({0.0, 0.0}), vector({-1.0}), coarse_between(-2.0, 1.0), {}};
}

BOOST_AUTO_TEST_SUITE(checkpoints)

BOOST_AUTO_TEST_CASE(branches_in_series_and_in_both_directions) {
  Case of = two_pitchforks();
  check_every_rest(of);
  of.p = vector({-0.5});
  of.limits.both_ways = true;
  of.limits.max_branches = 3;  // what is left out is reported once, too
  check_every_rest(of);
}

BOOST_AUTO_TEST_CASE(a_branch_that_joins_another) {
  // x (x² - p (1 - p)) = 0: pitchforks at p = 0 and p = 1 joined by a closed loop.
  auto problem = scalar([](double x, const Vector& p) { return x * (x * x - p[0] * (1.0 - p[0])); });
  problem->fingerprint_of = sizes;
  check_every_rest({{problem}, vector({0.0}), vector({-1.0}), coarse_between(-2.0, 2.0), {}});
}

BOOST_AUTO_TEST_CASE(folds_and_a_closed_curve) {
  const auto circle = scalar([](double x, const Vector& p) { return x * x + p[0] * p[0] - 1.0; });
  check_every_rest({{circle}, vector({0.6}), vector({0.8}), coarse_between(-2.0, 2.0), {}});
}

BOOST_AUTO_TEST_CASE(a_branch_lost_at_an_edge) {
  const auto edge = scalar([](double x, const Vector& p) {
    if (x > 0.5) throw std::domain_error("x too large");
    return x - p[0] * p[0];
  });
  check_every_rest({{edge}, vector({0.0}), vector({0.0}), coarse_between(-0.1, 2.0), {}});
}

BOOST_AUTO_TEST_CASE(events_and_adaptation_change_the_problem) {
  // Beyond x = 1 the branch goes on as a problem with one equation more, which is later given a third.
  auto before = std::make_shared<AlgebraicProblem>(
      1, [](const Vector& x, const Vector& p) { return Vector((x.array().cube() - p[0]).matrix()); });
  auto after = std::make_shared<AlgebraicProblem>(
      2, [](const Vector& x, const Vector& p) { return Vector((x.array().square() - p[0]).matrix()); });
  auto adapted = std::make_shared<AlgebraicProblem>(*after);
  adapted->set_size(3);
  const auto positive = [](const Vector& x, const Vector&) {
    return std::vector<EventFunction>{{"contact", 1.0 - x[0]}};
  };
  before->events_of = positive;
  before->transition_of = [after](std::size_t, const Vector&, const Vector&) {
    Transition transition;
    transition.problem = after->clone();
    transition.state = vector({1.0, 1.0});
    transition.before = "thin", transition.after = "thick";
    return std::optional<Transition>(transition);
  };
  after->adapt_of = [](AlgebraicProblem& self, const Vector& x, const Vector& p) -> std::optional<Vector> {
    if (p[0] < 2.0 || self.size() == 3) return std::nullopt;
    self.set_size(3);
    return Vector::Constant(3, x[0]);
  };
  check_every_rest({{before, after, adapted}, vector({0.5}), vector({0.125}), coarse_between(0.1, 4.0), {}});
}

BOOST_AUTO_TEST_CASE(a_stopped_diagram_goes_on) {
  const Case of = two_pitchforks();
  Log whole(of), second(of);
  trace_diagram(of.problems[0]->clone(), of.x, of.p, of.options, of.limits, whole);
  Log first(of);
  first.stop_after = 4;
  BOOST_TEST(trace_diagram(of.problems[0]->clone(), of.x, of.p, of.options, of.limits, first).stopped);
  BOOST_REQUIRE(first.lines.back().starts_with("end stopped"));
  first.lines.pop_back();  // where it goes on the branch has no end
  const Diagram resumed = resume_diagram(restored(of, first.stored), of.options, of.limits, second);
  BOOST_TEST(!resumed.stopped);
  first.lines.insert(first.lines.end(), second.lines.begin(), second.lines.end());
  BOOST_TEST(first.lines == whole.lines, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(damaged_data_are_refused) {
  const Case of = two_pitchforks();
  Log log(of);
  log.kill_at = 9;
  BOOST_CHECK_THROW(trace_diagram(of.problems[0]->clone(), of.x, of.p, of.options, of.limits, log), Killed);
  const nlohmann::json good = nlohmann::json::from_cbor(log.stored);
  decode(good, of.options, of.codec());
  for (const char* key : {"format", "diagram", "pending", "walk", "folds"}) {
    nlohmann::json damaged = good;
    damaged.erase(key);
    BOOST_CHECK_THROW(decode(damaged, of.options, of.codec()), std::runtime_error);
  }
  nlohmann::json other = good;
  other["walk"]["problem"] = 17;
  BOOST_CHECK_THROW(decode(other, of.options, of.codec()), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
