#pragma once

#include <functional>
#include <optional>
#include <span>

#include "windlass/measurement/friction_fit.hpp"

namespace windlass::measurement {

/// The axial force F0 [EI/ρ²] of the state at a measured point while everything slips with the coefficient `friction`; nothing
/// where there is no such state.
using Strength = std::function<std::optional<double>(std::size_t point, double friction)>;

/// Least squares of F0(T, mu) where friction changes the shape of the rod, so that F0 = mu Σ N d_z is not proportional to mu:
/// Gauss–Newton, the weights and errors of fit_friction() on the linearised strengths.
/// @param points  their R_tot on return is F0/mu of the state at the fitted coefficient
/// @param start   a coefficient at which all states exist, > 0
/// @throws InputError for fewer than two points
/// @throws std::runtime_error where a state is lost on the way, or the coefficient does not settle
FrictionFit fit_dragged(std::span<ComparedPoint> points, Weights weights, double start,
                        const Strength& strength);

}  // namespace windlass::measurement
