#pragma once

#include <cmath>

/// The planar capstan with very long tails, in closed form (PHYSICS, "Known exactly"; the paper's Eqs. for T, p, f,
/// R_tot and phi_star). Dimensionless, ρ = EI = 1; T the pull, phi the capstan angle [rad].
namespace windlass::rod::capstan {

/// Least tension with a line contact.
inline double line_limit(double phi) { return phi < M_PI ? 0.5 / (1.0 - std::cos(0.5 * phi)) : 0.5; }
inline bool line_contact(double tension, double phi) { return tension >= line_limit(phi); }

/// β = arccos(1 − 1/(2T)), the angle between the tail's first tangent and the pull. T >= 1/4.
inline double beta(double tension) { return 2.0 * std::asin(0.5 / std::sqrt(tension)); }
inline double phi_star(double tension, double phi) { return 0.5 * phi - beta(tension); }
inline double pressure(double tension) { return tension - 0.5; }
inline double edge_force(double tension) { return 0.5 * std::sqrt(4.0 * tension - 1.0); }
/// Total contact force; below the line-contact limit for phi < π that of a single touch, 2 T sin(phi/2).
inline double total_force(double tension, double phi) {
  if (phi < M_PI && !line_contact(tension, phi)) return 2.0 * tension * std::sin(0.5 * phi);
  return (2.0 * tension - 1.0) * phi_star(tension, phi) + std::sqrt(4.0 * tension - 1.0);
}
/// α = dlog R_tot/dlog T on the line contact.
inline double log_slope(double tension, double phi) {
  return 1.0 + phi_star(tension, phi) / total_force(tension, phi);
}
/// Angle between tangent and pull at distance d along the tail.
inline double tail_angle(double tension, double d) {
  return 4.0 * std::atan(std::tan(0.25 * beta(tension)) * std::exp(-std::sqrt(tension) * d));
}
/// Surgical knot of n throws: n single loops, n R_tot(2π), against one coil of n turns, R_tot(2nπ).
inline double knot_of_loops(double tension, int throws) { return throws * total_force(tension, 2.0 * M_PI); }
inline double knot_of_coil(double tension, int throws) { return total_force(tension, 2.0 * throws * M_PI); }

}  // namespace windlass::rod::capstan
