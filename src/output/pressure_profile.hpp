#pragma once

#include <optional>
#include <string>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/output/rod_curve.hpp"
#include "windlass/scene/scene.hpp"

/// p along s with the point forces as impulses on an axis of their own.
namespace windlass::output {

/// Largest values of a rod, 0 where there is no contact.
struct Heights {
  double pressure = 0.0, force = 0.0;  ///< [EI/ρ³], [EI/ρ²]
};
Heights heights_of(const RodCurve& curve, const std::vector<PointForce>& forces);

/// One block a line contact: s, p.
std::string pressure_data(const RodCurve& curve, const equilibrium::Solution& solution);
/// s, f.
std::string force_data(const std::vector<PointForce>& forces);

/// @param stem  of the data files, STEM-pressure.dat and STEM-forces.dat
std::string pressure_commands(const std::vector<PointForce>& forces, const std::string& stem,
                              const Heights& heights, const std::optional<scene::Units>& units);

}  // namespace windlass::output
