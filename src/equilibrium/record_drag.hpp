#pragma once

#include "windlass/equilibrium/record.hpp"

/// What is recorded of a rod that a cylinder slips along (PHYSICS, "Steady sliding").
namespace windlass::equilibrium {

/// Of a cylinder that slips along the rod, and the plate that holds it back.
void record_drag(const RodProblem& problem, const Vector& x, const contact::Loads& loads,
                 const scene::Scene& scene, Solution& out);

/// Of a dragged state only what friction leaves is conserved: the axial torque where the rod does not run along itself.
/// The residual of the forces is that of the contacts of the cylinder, across the axis: N (e_r + mu d).
/// @param compliance  1/EA: a rod that stretches runs faster along itself
void measure_drag(Solution& out, double friction, double compliance);

}  // namespace windlass::equilibrium
