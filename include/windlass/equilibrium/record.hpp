#pragma once

#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/solution.hpp"

/// From a discrete state to the value that is written, plotted and checked, and back.
namespace windlass::equilibrium {

/// The whole rod (both halves) at state x and parameters p, in the units of the scene as its user wrote it. Error estimate
/// and iterations are the problem's last.
Solution record(RodProblem& problem, const Vector& x, const Vector& p);

/// Topology, meshes and units of the state as JSON text.
std::string chain_of(const RodProblem& problem);

/// Units of a state stored with that text. @throws nlohmann::json::exception for text that is no chain
scene::Units units_of(const std::string& chain);

/// The problem so described, of a scene as its user wrote it. @throws std::exception for text that is no chain
std::shared_ptr<RodProblem> rebuild(const scene::Scene& scene, const std::string& chain,
                                    const std::vector<std::string>& keys);

/// Chain description and state, for Solution::restart.
Restart restart_of(const RodProblem& problem, const Vector& x);

/// The problem and state a stored solution came from. @throws std::runtime_error for damaged restart data
std::shared_ptr<RodProblem> reopen(const scene::Scene& scene, const Restart& restart,
                                   const std::vector<std::string>& keys);

/// Largest drift of the invariants along the rod and the residual of the force balance; fills solution.invariants.
void measure_invariants(Solution& solution, const chain::RodKind& kind, const contact::Loads& loads);

}  // namespace windlass::equilibrium
