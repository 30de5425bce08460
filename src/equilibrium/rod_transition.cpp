#include <cmath>
#include <optional>

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/rod_problem.hpp"

namespace windlass::equilibrium {

namespace {

/// Can this state be the continuation? At the event itself forces vanish, to within rounding.
bool admissible(const std::vector<ContactEvent>& events) {
  for (const ContactEvent& event : events)
    if (event.value < (event.kind == ContactEvent::Kind::length ? 1e-6 : -1e-6)) return false;
  return true;
}

}  // namespace

std::vector<continuation::EventFunction> RodProblem::events(const Vector& x, const Vector& p) {
  std::vector<continuation::EventFunction> out;
  if (!scene_.has_cylinder) return out;
  for (const ContactEvent& event : contact_events(profile(x, p), topology_))
    out.push_back({event.name(), event.value});
  return out;
}

std::optional<continuation::Transition> RodProblem::transition(std::size_t which, const Vector& x,
                                                               const Vector& p) {
  const contact::Loads at = loads(p);
  const chain::Profile shape = profile(x, p);
  const ContactEvent event = contact_events(shape, topology_).at(which);
  std::vector<double> s;
  for (int j = 0; j < chain_->joint_count(); ++j) {
    const double here = chain_->arclength(x, at, j);
    s.push_back(std::isinf(here) ? (here > 0.0 ? shape.end() : shape.begin()) : here);
  }
  std::optional<continuation::Transition> first;
  for (const Successor& next : successors(event, shape, topology_, s)) {
    continuation::Transition transition;
    transition.before = topology_.text();
    transition.after = next.topology.text();
    if (next.nothing_left) {
      transition.after = "no contact";
      return transition;  // null problem: the branch ends here
    }
    std::vector<chain::ArcMesh> meshes;
    for (int source : next.source) meshes.push_back(meshes_.empty() ? chain::ArcMesh{} : meshes_[source]);
    for (std::size_t i = 0; i < meshes.size(); ++i)
      if (meshes[i].nodes.size() < 5) meshes[i].nodes = chain::uniform_mesh(4);  // was a closed form, or tiny
    auto problem = std::make_shared<RodProblem>(scene_, spatial_, next.topology, meshes, keys_);
    Vector guess = chain::guess_state(problem->chain(), next.topology, rod_, shape, next.s);
    transition.state = guess;
    transition.problem = problem;
    if (!first) first = transition;
    // Prefer a successor that has a solution right here, or (a new arc has no length at the event itself) a little to
    // either side of it, with its contacts intact.
    for (const double offset : {0.0, -0.02, 0.02, -0.008, 0.008, -0.002, 0.002}) {
      Vector beside = p, y = guess;
      beside(0) += offset * std::max(1.0, std::abs(p(0)));
      try {
        if (problem->polish(y, beside, 18) < 0) continue;
        if (!admissible(contact_events(problem->profile(y, beside), problem->topology()))) continue;
        transition.state = y;
        if (offset != 0.0) transition.p = beside;
        return transition;
      } catch (const std::exception&) {  // a length or tension left its domain: not this one
      }
    }
  }
  return first;
}

}  // namespace windlass::equilibrium
