#pragma once

#include "windlass/discrete_rod/thick_energy.hpp"

namespace windlass::discrete_rod {

/// Is it positive definite?
bool convex(const ThickEnergy::Sparse& hessian);

/// One minimisation by TAO from x, until the gradient is below `tolerance`.
/// @return iterations, or −1 and x as far as it came
int descend(ThickEnergy& energy, double tolerance, ThickEnergy::Vector& x);

}  // namespace windlass::discrete_rod
