#pragma once

#include <memory>

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/rod_problem.hpp"

namespace windlass::equilibrium {

/// A state on another topology, and the parameters at which it is one.
struct Entry {
  std::shared_ptr<RodProblem> problem;
  Vector x, p;
};

/// Can this state be the continuation? At the event itself forces vanish, to within rounding.
bool admissible(const std::vector<ContactEvent>& events);
bool holds(const Entry& entry);

/// The successor's problem, with the old shape as guess.
Entry draft(const RodProblem& from, const Successor& next, const chain::Profile& shape, const Vector& p);

}  // namespace windlass::equilibrium
