#pragma once

#include <optional>
#include <string>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/obstacle/surface.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/rod_curve.hpp"
#include "windlass/output/tube_view.hpp"

namespace windlass::output {

/// A strut has no cylinder: one side view, or two of equal scale when it leaves its plane, with its point
/// forces.
/// @param stem  of the data files STEM-curve.dat (s x y z p) and, of a rod with a radius, STEM-tube-1.dat and -2.dat
/// @param obstacles   drawn where they are flat and seen from the side
/// @param stroke      without a radius: a line
Picture strut_picture(const equilibrium::Solution& solution, const RodCurve& curve,
                      const obstacle::Set& obstacles, const Stroke& stroke, const std::string& title,
                      const std::string& subtitle, const std::string& stem);

/// The tube of view 1 (x, y) or 2 (x, z) as polygons.
std::string strut_tube(const RodCurve& curve, const Stroke& stroke, int view);

}  // namespace windlass::output
