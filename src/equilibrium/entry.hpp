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

/// The event to see to first in a state that violates some: what is in the wrong order, then what overlaps, then what pulls. Next to
/// a touch whose curvature is negative it is that touch that is two. nullptr: all hold.
/// @param redrawn  only those that leave the state as it is
const ContactEvent* most_violated(const std::vector<ContactEvent>& events, double unit, bool redrawn = false);

/// Goes on to the contacts that follow, at the same parameters, until all hold.
/// @param redrawn  only by events that leave the state as it is
/// @returns whether they do
bool mend(Entry& at, int most, bool redrawn, int& iterations);

/// The successor's problem, with the old shape as guess.
Entry draft(const RodProblem& from, const Successor& next, const chain::Profile& shape, const Vector& p);

}  // namespace windlass::equilibrium
