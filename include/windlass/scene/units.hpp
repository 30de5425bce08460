#pragma once

#include <string_view>

#include "windlass/scene/scene.hpp"

namespace windlass::scene {

enum class Dimension {
  none,          ///< a plain number
  angle,         ///< rad; a plain number, "2 pi", "pi/2", "90 deg"
  length,        ///< m
  curvature,     ///< 1/m
  force,         ///< N, or a hung mass
  compliance,    ///< 1/N
  distributed,   ///< N/m
  stiffness,     ///< N m², bending stiffness
  modulus,       ///< Pa
  of_parameter,  ///< that of the key named by continuation.parameter
};

/// True for what a dimensionless scene writes as a number and a physical one with a unit.
bool is_dimensional(Dimension dimension);

/// "a length such as \"4 mm\"", for messages.
std::string_view description(Dimension dimension);

/// Angle in rad: [number] ["pi" or "deg" or "rad" or "turn"] ["/" number], in this order, "*" allowed.
/// @throws std::invalid_argument with what is allowed
double parse_angle(std::string_view text);

/// Quantity in SI units, read by udunits2: "4 mm", "1.2 MPa", "0.4e-3 N m^2". A mass where a force is asked is a
/// hung mass, m · 9.80665 m/s².
/// @throws std::invalid_argument with what is allowed
double parse_quantity(std::string_view text, Dimension dimension);

/// What a dimensionless number of that dimension is multiplied with to give SI units.
double scale_of(const Units& units, Dimension dimension);

/// The units every solver works in: EI = 1 and, for rods without a cylinder, a length of 1. So no threshold there depends
/// on the units of the scene.
Units natural_units(const Scene& scene);

/// The scene with every number divided by its unit; `solved_in` says by what.
Scene in_units(Scene scene, const Units& units);
Scene natural(const Scene& scene);

/// The scene as its user wrote it, and a value of one of its keys.
Scene as_given(const Scene& solved);
double as_given(const Scene& solved, std::string_view key, double value);

}  // namespace windlass::scene
