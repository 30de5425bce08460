#pragma once

#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/solution.hpp"

/// The moment of the friction in a coil that lies in the plate (PHYSICS, "The moment of the friction", flat coils).
namespace windlass::equilibrium {

/// Is the rod held in the plate wherever it touches the cylinder, and by nothing else? Its torsion then follows from the contact
/// forces, and acts back on nothing.
bool lies_in_plate(const Topology& topology);

/// Does a coil that the moment of the friction twists stay there? Under a plate that ends its tails would not, nor what is between
/// two touches where only one end holds the spin: the torsion does not vanish there.
bool stays_in_plate(const Topology& topology, const scene::Scene& scene);

/// Adds to a flat coil, computed without, the torsion M by the moment of the friction, n_z = M θ'/λ, the turn of its frames, and
/// the plate's pressure on its tails and ends. A tail that is pressed becomes a line on the plate.
/// @param scene  of the state; at least one of its ends holds the spin
void add_flat_torsion(const scene::Scene& scene, Solution& out);

}  // namespace windlass::equilibrium
