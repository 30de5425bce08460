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
/// Colour of a point force, 0xRRGGBB: of an obstacle or of another strand.
inline constexpr unsigned obstacle_colour = 0xc00000, strand_colour = 0x0072b2;
inline unsigned force_colour(const PointForce& force) {
  return force.partner ? strand_colour : obstacle_colour;
}
inline constexpr const char* strand_force_style = "lc rgb '#0072b2'";  ///< the same for gnuplot

/// s, f, colour.
std::string force_data(const std::vector<PointForce>& forces);

/// @param stem  of the data files, STEM-pressure.dat and STEM-forces.dat
std::string pressure_commands(const std::vector<PointForce>& forces, const std::string& stem,
                              const Heights& heights, const std::optional<scene::Units>& units);

}  // namespace windlass::output
