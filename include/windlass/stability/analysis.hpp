#pragma once

#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/solution.hpp"
#include "windlass/stability/spectrum.hpp"

namespace windlass::stability {

/// Index, lowest eigenvalues and modes of one equilibrium, both parities of a half chain taken together.
///
/// `index` comes from SLEPc's eigenvalues, `inertia_index` from the chain's own factorisation; `degenerate`: a contact
/// carries nothing, or an eigenvalue is zero to rounding. Eigenvalues are those of the second
/// variation against ∫ |δ(rotation)|² ds of the whole rod [EI/ρ²].
///
/// @param count  eigenvalues wanted, >= 1
/// @param modes  also the mode shapes (displacement along the rod, largest entry 1)
/// @throws petsc::Error, std::runtime_error as SpectrumSolver::lowest
equilibrium::Stability analyse(equilibrium::RodProblem& problem, const continuation::Vector& x,
                               const continuation::Vector& p, int count, bool modes, SpectrumSolver& solver);

/// Modes of the whole rod, of both parities, that cost nothing at any load: of arcs about to buckle by themselves, see
/// contact::spatial::FreeRodEnd.
int neutral_modes(const equilibrium::RodProblem& problem);

/// Displacement of the whole rod for an increment of the chain, and its character.
equilibrium::Mode mode_of(equilibrium::RodProblem& problem, const continuation::Vector& x,
                          const continuation::Vector& p, const continuation::Vector& increment,
                          contact::Parity parity);

}  // namespace windlass::stability
