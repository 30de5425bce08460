#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

#include "algebraic_problem.hpp"
#include "continuation/bracket.hpp"
#include "continuation/corrector.hpp"
#include "continuation/step_length.hpp"
#include "walk.hpp"

namespace {

using namespace continuation;
using namespace continuation::testing;

BOOST_AUTO_TEST_SUITE(policies)

BOOST_AUTO_TEST_CASE(step_length_sequence) {
  Options options;
  options.step = 0.1;
  options.step_min = 0.02;
  options.step_max = 0.5;
  options.target_newton = 4;
  options.target_contraction = 0.1;
  StepLength step(options);
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-15; };
  BOOST_TEST(close(step.current(), 0.1));
  step.accepted(2, 1e-4);  // 2^((4-2)/2) = 2
  BOOST_TEST(close(step.current(), 0.2));
  step.accepted(4, 0.1);  // on target
  BOOST_TEST(close(step.current(), 0.2));
  step.accepted(3, 0.09);  // min(√2, √(0.1/0.09)) = √(10/9)
  BOOST_TEST(close(step.current(), 0.2 * std::sqrt(0.1 / 0.09)));
  BOOST_TEST(step.rejected());
  const double halved = 0.1 * std::sqrt(0.1 / 0.09);
  BOOST_TEST(close(step.current(), halved));
  step.accepted(1, 0.0);  // no growth right after a rejection
  BOOST_TEST(close(step.current(), halved));
  step.accepted(1, 0.0);  // then clamped to 2
  BOOST_TEST(close(step.current(), 2.0 * halved));
  step.accepted(0, 0.0);
  step.accepted(0, 0.0);
  BOOST_TEST(close(step.current(), 0.5));  // step_max
  step.accepted(8, 0.9);                   // √(0.1/0.9) = ⅓, clamped to ½
  BOOST_TEST(close(step.current(), 0.25));
  step.reset(0.03);
  BOOST_TEST(!step.rejected());  // 0.015 < step_min: refused, unchanged
  BOOST_TEST(close(step.current(), 0.03));
}

BOOST_AUTO_TEST_CASE(options_name_the_violated_bound) {
  const auto message = [](auto change) -> std::string {
    Options options;
    change(options);
    try {
      options.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  BOOST_TEST(message([](Options&) {}) == "");
  BOOST_TEST(message([](Options& o) { o.step = 2.0; }) ==
             "continuation options: step <= step_max is violated, the value is 2");
  BOOST_TEST(message([](Options& o) { o.direction = 0; }).find("direction = 1 or -1") != std::string::npos);
  BOOST_TEST(message([](Options& o) { o.step_min = 0.0; }).find("step_min > 0") != std::string::npos);
  BOOST_TEST(message([](Options& o) { o.newton_tolerance = NAN; }).find("newton_tolerance") !=
             std::string::npos);
}

Borders fixed(double value) {
  return Borders{0, 1.0, Matrix(1, 0), Matrix::Zero(1, 1), Matrix::Ones(1, 1), Vector::Constant(1, value)};
}

BOOST_AUTO_TEST_CASE(exact_guess_takes_no_correction) {
  auto problem = scalar([](double x, const Vector& p) { return x * x - p[0]; });
  Iterate it{vector({2.0}), vector({0.0}), vector({4.0}), vector({0.0})};
  const auto report = correct(*problem, fixed(0.0), it, Options{});
  BOOST_TEST(report.converged);
  BOOST_TEST(report.iterations == 0);
  BOOST_TEST(report.factorizations == 1);
  BOOST_TEST(report.factored_here);
  BOOST_TEST(it.x[0] == 2.0);
}

BOOST_AUTO_TEST_CASE(corrector_converges_and_reuses_factorisations) {
  auto problem = scalar([](double x, const Vector& p) { return x * x - p[0]; });
  Iterate it{vector({2.001}), vector({0.0}), vector({4.0}), vector({0.0})};
  const auto report = correct(*problem, fixed(0.0), it, Options{});
  BOOST_TEST(report.converged);
  BOOST_TEST(std::abs(it.x[0] - 2.0) < 1e-12);
  BOOST_TEST(report.factorizations == 1);  // θ = |e|/2x = 2.5e-4: chord corrections do
  BOOST_TEST(std::abs(report.contraction - 2.5e-4) < 1e-5);
  // u is the sum of what was added.
  BOOST_TEST(std::abs(it.u[0] - (it.x[0] - 2.001)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(rounding_of_a_large_state_is_not_a_failure) {
  // x = 3.3e7: an ulp of x² moves x by 4e-9, more than the tolerance, so that corrections stagnate.
  auto problem = scalar([](double x, const Vector& p) { return 1e-15 * (x * x - 3.3e7 * 3.3e7 * p[0]); });
  Iterate it{vector({3.1e7}), vector({0.0}), vector({1.0}), vector({0.0})};
  Options options;
  options.max_newton = 12;
  const auto report = correct(*problem, fixed(0.0), it, options);
  BOOST_TEST(report.converged);
  BOOST_TEST(std::abs(it.x[0] / 3.3e7 - 1.0) < 1e-14);
}

BOOST_AUTO_TEST_CASE(corrector_reports_failures) {
  auto none = scalar([](double x, const Vector& p) { return x * x + 1.0 + p[0]; });
  Iterate it{vector({1.0}), vector({0.0}), vector({0.0}), vector({0.0})};
  auto report = correct(*none, fixed(0.0), it, Options{});
  BOOST_TEST(!report.converged);
  BOOST_TEST(!report.failure.empty());

  auto domain = scalar([](double, const Vector&) -> double { throw std::domain_error("rod too short"); });
  report = correct(*domain, fixed(0.0), it, Options{});
  BOOST_TEST(report.failure == "outside the domain: rod too short");

  auto nan = scalar([](double, const Vector&) { return std::nan(""); });
  report = correct(*nan, fixed(0.0), it, Options{});
  BOOST_TEST(report.failure == "the residual is not finite");
}

BOOST_AUTO_TEST_CASE(a_problem_may_bring_its_own_solver) {
  // Plain Newton on the pieces that the library hands out; a whole branch goes through it.
  struct Plain final : BorderedNewton {
    int solves = 0;
    CorrectorReport solve(Problem& problem, const Borders& borders, Iterate& iterate,
                          const Options& options) override {
      ++solves;
      CorrectorReport report;
      BorderedSystem system(problem, borders, iterate);
      StoppingRule rule(options);
      for (; !report.converged && report.iterations <= options.max_newton; ++report.iterations) {
        const Vector& defect = system.defect();
        system.factor();
        const Vector delta = system.solve(defect);
        report.converged = rule.last(system.length(delta), system.residual(), system.state_size(), true);
        system.add(delta);
      }
      return report;
    }
  };
  class Own : public AlgebraicProblem {
   public:
    using AlgebraicProblem::AlgebraicProblem;
    BorderedNewton* newton() override { return &solver; }
    std::shared_ptr<Problem> clone() const override { return std::make_shared<Own>(*this); }
    Plain solver;
  };
  auto own = std::make_shared<Own>(
      1, [](const Vector& x, const Vector& p) { return vector({p[0] - 1.0 + (x[0] - 0.3) * (x[0] - 0.3)}); });
  Options options;
  options.lower = -1.0;
  Walker walker(own, vector({-0.9}), vector({-0.4}), options);
  const auto folds = of_type(walk(walker), PointType::fold);
  BOOST_REQUIRE_EQUAL(folds.size(), 1u);
  BOOST_TEST(std::abs(folds[0].p[0] - 1.0) < 1e-12);
  BOOST_TEST(own->solver.solves > 5);
}

BOOST_AUTO_TEST_CASE(chord_corrections_go_on_below_what_the_metric_shows) {
  Options options;
  options.newton_tolerance = 1e-9;
  StoppingRule rule(options);
  // By an old factorisation, each a tenth of the one before: the first below the tolerance leaves a tenth of it.
  BOOST_TEST(!rule.last(1e-8, 1e-9, 1.0, false));
  BOOST_TEST(!rule.settling());
  BOOST_TEST(!rule.last(9e-10, 1e-10, 1.0, false));
  BOOST_TEST(rule.settling());
  BOOST_TEST(!rule.last(9e-11, 1e-11, 1.0, false));
  BOOST_TEST(rule.last(9e-12, 1e-12, 1.0, false));
  BOOST_TEST(!rule.settling());
  // By the state's own one such correction is the last.
  StoppingRule fresh(options);
  BOOST_TEST(!fresh.last(1e-5, 1e-6, 1.0, true));
  BOOST_TEST(fresh.last(9e-10, 1e-11, 1.0, true));
}

BOOST_AUTO_TEST_CASE(corrections_made_of_noise_are_over) {
  Options options;
  options.newton_tolerance = 1e-9;
  options.residual_tolerance = 1e-8;
  using Guess = StoppingRule::Guess;
  // F is what rounding leaves of it, and nearly singular equations make 1e-7 of that.
  StoppingRule noisy(options, Guess::near, [] { return 1e-11; });
  BOOST_TEST(!noisy.last(1e-7, 3e-11, 1.0, true));
  BOOST_TEST(noisy.last(1.2e-7, 2e-11, 1.0, true));
  // Of an F that could still fall they are not.
  StoppingRule growing(options, Guess::near, [] { return 1e-13; });
  BOOST_TEST(!growing.last(1e-7, 3e-11, 1.0, true));
  BOOST_CHECK_THROW(growing.last(1.2e-7, 2e-11, 1.0, true), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(the_noise_of_a_system_is_what_rounding_makes_of_it) {
  // F = a (x - 1) summed over terms of size a: some a ε.
  const double a = 1e6;
  AlgebraicProblem sums(1, [&](const Vector& x, const Vector& p) { return vector({a * x[0] - a * p[0]}); });
  Borders none;
  none.psi = none.c = Matrix::Zero(1, 0);
  none.d = Matrix::Zero(0, 0);
  none.g = Vector::Zero(0);
  Iterate at{vector({1.0}), vector({0.0}), vector({1.0}), Vector::Zero(0)};
  BorderedSystem system(sums, none, at);
  const double epsilon = std::numeric_limits<double>::epsilon();
  BOOST_TEST(system.noise() >= 0.5 * a * epsilon);
  BOOST_TEST(system.noise() <= 4.0 * a * epsilon);
}

BOOST_AUTO_TEST_CASE(find_zero_shuts_in) {
  int calls = 0;
  const auto f = [&](double x) -> std::optional<double> {
    ++calls;
    return std::cos(x) - x;
  };
  const auto bracket = find_zero(0.0, 1.0, 1.0, std::cos(1.0) - 1.0, 1e-12, f);
  BOOST_TEST(bracket.converged);
  BOOST_TEST(bracket.hi - bracket.lo <= 1.1e-12);
  BOOST_TEST(std::abs(bracket.best - 0.7390851332151607) < 1e-12);
  BOOST_TEST(calls < 12);
  // A function that declines leaves the bracket reached so far.
  const auto partial = find_zero(0.0, 1.0, 1.0, -1.0, 1e-12, [&](double) { return std::optional<double>(); });
  BOOST_TEST(!partial.converged);
  BOOST_TEST(partial.lo == 0.0);
  BOOST_TEST(partial.hi == 1.0);
}

BOOST_AUTO_TEST_CASE(find_zero_ends_where_its_function_is_rounding) {
  // A zero at 1/√2, with noise of 1e-6: no bracket of 1e-12 tells more of it than one as wide as the noise.
  const double zero = std::sqrt(0.5), noise = 1e-6;
  int calls = 0;
  const auto f = [&](double x) {
    ++calls;
    return std::optional<double>(2.0 * (x - zero) + 0.5 * (x - zero) * (x - zero) +
                                 noise * std::sin(1e13 * x));
  };
  const auto bracket = find_zero(0.0, *f(0.0), 1.0, *f(1.0), 1e-12, f);
  BOOST_TEST(bracket.converged);
  BOOST_TEST(calls < 20);
  BOOST_TEST(std::abs(bracket.best - zero) <= bracket.noise + bracket.hi - bracket.lo);
  BOOST_TEST(bracket.noise < 10.0 * noise);
}

BOOST_AUTO_TEST_CASE(default_inner_and_dual_agree) {
  class Plain : public AlgebraicProblem {
   public:
    using AlgebraicProblem::AlgebraicProblem;
    double inner(const Vector& a, const Vector& b) const override { return Problem::inner(a, b); }
  };
  Plain problem(3, [](const Vector& x, const Vector&) { return x; });
  const Vector a = vector({1.0, 2.0, 3.0}), b = vector({-1.0, 0.5, 2.0});
  BOOST_TEST(std::abs(problem.dual(a).dot(b) - problem.inner(a, b)) < 1e-15);
  BOOST_TEST(std::abs(problem.inner(a, a) - 14.0 / 3.0) < 1e-15);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
