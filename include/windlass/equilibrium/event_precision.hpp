#pragma once

#include <continuation/point.hpp>
#include <optional>
#include <string>

#include "windlass/equilibrium/rod_problem.hpp"

namespace windlass::equilibrium {

/// How far the mesh has moved a contact event: the distance in p(0) between its zero on the problem's mesh, at (x, p), and
/// on the same elements with one stage more, doubled like all error estimates. Nothing where the state there is
/// singular, as it is where an arc vanishes.
/// @param event  its name, see ContactEvent::name
std::optional<double> event_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                      const std::string& event);

/// The same of a fold or a branch point of that multiplicity. Nothing where it is not found on the finer mesh.
std::optional<double> singular_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                         continuation::PointType type, int multiplicity);

/// The same for the touches that stand for lines between strands (PHYSICS, "Lines between turns"): the strands are nearer between them,
/// and a line's end is off by the root of that. Nothing where there are none.
std::optional<double> layout_precision(const RodProblem& problem, const Vector& x, const Vector& p,
                                       const std::string& event);

}  // namespace windlass::equilibrium
