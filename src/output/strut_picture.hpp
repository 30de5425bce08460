#pragma once

#include <optional>
#include <string>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/obstacle/surface.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/rod_curve.hpp"

namespace windlass::output {

/// A strut has no cylinder: one side view, or two of equal scale when it leaves its plane, with its point forces.
/// @param stem  of the data file STEM-curve.dat (s x y z p)
/// @param obstacles  drawn where they are flat and seen from the side
Picture strut_picture(const equilibrium::Solution& solution, const RodCurve& curve,
                      const obstacle::Set& obstacles, const std::string& title, const std::string& subtitle,
                      const std::string& stem);

}  // namespace windlass::output
