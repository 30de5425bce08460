#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "windlass/scene/scene.hpp"

/// What was measured on a real rod, and what it says about the friction coefficient.
namespace windlass::measurement {

/// One measured sliding strength, dimensionless.
struct Measurement {
  double T = 0.0;                  ///< pull at each end [EI/ρ²]
  double F0 = 0.0;                 ///< axial force at which the cylinder slides [EI/ρ²]
  std::optional<double> F0_error;  ///< its standard deviation [EI/ρ²]
  int line = 0;                    ///< in the file
};

/// Reads a CSV file whose header names the columns `T`, `F0` and, if wanted, `F0_error`, in any order. A unit stands in
/// brackets after the name, `T [g]`, `F0 [N]`: any force, or a hung mass. Without it the column is dimensionless.
/// Lines that are empty or start with # are passed over.
/// @param units  scales of the scene; empty for a dimensionless one, which can use no column with a unit
/// @throws InputError naming file, line and column, what stands there, and what is allowed
std::vector<Measurement> read_measurements(const std::filesystem::path& path,
                                           const std::optional<scene::Units>& units);

}  // namespace windlass::measurement
