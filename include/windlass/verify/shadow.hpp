#pragma once

#include <vector>

#include "windlass/verify/rod_flow.hpp"

namespace windlass::verify {

/// A true trajectory near two neighbouring stored samples.
struct Shadow {
  std::vector<Section> stations;  ///< sections of the trajectory, both ends included, evenly spaced
  Section start, end;             ///< equal to stations.front() and stations.back()
  double contact_force = 0.0;     ///< ∫ p ds along it
  double virial = 0.0;            ///< RodFlow::virial along it
  bool converged = false;
};

/// The trajectory of `flow` over a length h whose two ends lie closest to `first` and `last` (least squares).
///
/// Plain integration from `first` multiplies its rounding errors by exp(growth h), growth ≈ √T, and says nothing
/// where that is large; but the distance of the samples from the nearest true trajectory is well conditioned. It is
/// found by multiple shooting over pieces with growth × length <= 3: minimise |x₀ - first|² + |x_M - last|² subject
/// to flow(x_k) = x_{k+1}, by Gauss-Newton with difference quotients of the flow (CVODE errors of 1e-12 over a
/// step of 1e-6 leave Jacobians good to about 1e-5, so three or four iterations suffice).
///
/// @param first,last  stored samples; their forces must agree on a free arc
/// @throws std::runtime_error when CVODE gives up
Shadow find_shadow(RodFlow& flow, equilibrium::ArcKind kind, const Section& first, const Section& last,
                   double h, double growth);

}  // namespace windlass::verify
