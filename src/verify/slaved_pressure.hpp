#pragma once

#include <vector>

#include "windlass/verify/rod_flow.hpp"

namespace windlass::verify {

/// A piece of a line whose friction turns or stretches the rod, where the layer w is short beside the piece, or w changes its sign in
/// it: w p = ν − n·N says nothing of p at a place then, but holds all along for one smooth pressure.
struct SlavedPiece {
  std::vector<Section> stations;  ///< from the start on, at equal distances
  std::vector<double> pressures;  ///< there [EI/ρ³]
  double contact_force = 0.0;     ///< ∫ p ds
  bool converged = false;
};

/// That pressure, a polynomial that is found, with the integration of the balance laws under it, from w p = ν − n·N at Radau's points
/// of the piece: as many unknowns as equations, for any size and sign of w.
/// @param guess  a pressure from where Newton's method starts
/// @param backward  integrate against s
SlavedPiece find_slaved(RodFlow& flow, const Stiffness& law, const Shape& shape, const Section& start,
                        double length, double guess, bool backward, int looks);

}  // namespace windlass::verify
