#include "windlass/equilibrium/event_precision.hpp"

#include <algorithm>
#include <cmath>
#include <continuation/relocated.hpp>

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/opening.hpp"

namespace windlass::equilibrium {

namespace {

/// Value of the event where the problem is solved at p, from a state nearby.
std::optional<double> value_at(RodProblem& problem, Vector& x, const Vector& p, const std::string& event) {
  if (problem.polish(x, p) < 0) return std::nullopt;
  return value_of(contact_events(problem.profile(x, p), problem.topology()), event);
}

/// The state, not yet solved for, on the same elements with one stage more.
struct Finer {
  RodProblem problem;
  Vector x;

  Finer(const RodProblem& coarse, const Vector& state, const Vector& p)
      : problem(coarse.scene_at(p), coarse.spatial(), coarse.topology(), meshes(coarse), coarse.keys()),
        x(chain::transfer_state(coarse.chain(), problem.chain(), state, problem.loads(p))) {}

 private:
  static std::vector<chain::ArcMesh> meshes(const RodProblem& coarse) {
    std::vector<chain::ArcMesh> out = coarse.meshes();
    for (chain::ArcMesh& mesh : out) mesh.stages += mesh.stages > 0;  // formulas stay
    return out;
  }
};

constexpr double safety = 2.0, believable = 1e-4;

}  // namespace

std::optional<double> event_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                      const std::string& event) {
  constexpr double difference = 1e-6;
  std::optional<double> precision;
  tried([&] {
    Finer finer(problem, x, p);
    const auto here = value_at(finer.problem, finer.x, p, event);
    Vector beside = p;
    beside(0) += difference * std::max(1.0, std::abs(p(0)));
    // Zero, but where the event is located by other means (Transition::located).
    const chain::Profile coarse =
        chain::profile(problem.chain(), problem.topology(), problem.rod(), x, finer.problem.loads(p));
    const auto own = value_of(contact_events(coarse, problem.topology()), event);
    const auto there = here && own ? value_at(finer.problem, finer.x, beside, event) : std::nullopt;
    if (!there || *there == *here) return false;
    const double distance = safety * std::abs((*here - *own) * (beside(0) - p(0)) / (*there - *here));
    if (distance < believable) precision = distance;
    return true;
  });
  return precision;
}

std::optional<double> singular_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                         continuation::PointType type, int multiplicity) {
  std::optional<double> precision;
  tried([&] {
    Finer finer(problem, x, p);
    continuation::Options options;
    options.parameter_scale = std::max(1.0, std::abs(p(0)));
    const auto there = continuation::relocated(finer.problem, options, finer.x, p, type, multiplicity);
    const double distance = there ? safety * std::abs(*there - p(0)) : HUGE_VAL;
    if (distance < believable * options.parameter_scale) precision = distance;
    return precision.has_value();
  });
  return precision;
}

}  // namespace windlass::equilibrium
