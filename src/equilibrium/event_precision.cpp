#include "windlass/equilibrium/event_precision.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/opening.hpp"

namespace windlass::equilibrium {

namespace {

/// Value of the event where the problem is solved at p, from a state nearby.
std::optional<double> value_at(RodProblem& problem, Vector& x, const Vector& p, const std::string& event) {
  if (problem.polish(x, p) < 0) return std::nullopt;
  return value_of(contact_events(problem.profile(x, p), problem.topology()), event);
}

}  // namespace

std::optional<double> event_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                      const std::string& event) {
  constexpr double safety = 2.0, difference = 1e-6, believable = 1e-4;
  std::optional<double> precision;
  tried([&] {
    std::vector<chain::ArcMesh> meshes = problem.meshes();
    for (chain::ArcMesh& mesh : meshes) mesh.stages += mesh.stages > 0;  // formulas stay
    RodProblem finer(problem.scene_at(p), problem.spatial(), problem.topology(), meshes, problem.keys());
    Vector fine = chain::transfer_state(problem.chain(), finer.chain(), x, finer.loads(p));
    const auto here = value_at(finer, fine, p, event);
    Vector beside = p;
    beside(0) += difference * std::max(1.0, std::abs(p(0)));
    // Zero, but where the event is located by other means (Transition::located).
    const chain::Profile coarse =
        chain::profile(problem.chain(), problem.topology(), problem.rod(), x, finer.loads(p));
    const auto own = value_of(contact_events(coarse, problem.topology()), event);
    const auto there = here && own ? value_at(finer, fine, beside, event) : std::nullopt;
    if (!there || *there == *here) return false;
    const double distance = safety * std::abs((*here - *own) * (beside(0) - p(0)) / (*there - *here));
    if (distance < believable) precision = distance;
    return true;
  });
  return precision;
}

}  // namespace windlass::equilibrium
