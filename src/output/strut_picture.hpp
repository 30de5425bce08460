#pragma once

#include <optional>
#include <string>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/rod_curve.hpp"

namespace windlass::output {

/// A strut has no cylinder: one side view, or two of equal scale when it leaves its plane.
/// @param stem  of the data file STEM-curve.dat (s x y z p)
Picture strut_picture(const equilibrium::Solution& solution, const RodCurve& curve, const std::string& title,
                      const std::string& subtitle, const std::string& stem);

}  // namespace windlass::output
