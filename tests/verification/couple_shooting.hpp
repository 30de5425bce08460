#pragma once

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

/// The oracle of dragged rods on touches, whose friction may have a moment about the centre line, and which may stretch: from the
/// first touch to both clamped ends, by Runge-Kutta-Fehlberg 7(8) of the first-order equations, and Newton's method on all that
/// is unknown.
namespace windlass::test {

struct Dragged {
  double drag = 0.0, contact_force = 0.0, travelled = 0.0;  ///< F0, R_tot, and τ or ω
};

/// @param guess  a state on isolated touches; where it touches, and from where Newton's method starts
Dragged shot_from_touches(const equilibrium::Solution& guess, const scene::Scene& scene);

}  // namespace windlass::test
