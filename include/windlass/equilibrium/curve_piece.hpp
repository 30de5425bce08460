#pragma once

#include <vector>

#include "windlass/chain/profile.hpp"
#include "windlass/discrete_rod/thick_contacts.hpp"
#include "windlass/rod/quaternion.hpp"

/// Curves of discrete rods as a state that guesses for chains are read from.
namespace windlass::equilibrium {

/// A place of a curve, with its derivatives in a parameter that is nearly arclength.
struct CurvePlace {
  double s;  ///< arclength [ρ]
  Eigen::Vector3d r, slope, bend;
};

/// The rod along these places, without torsion (its ends are free of it): frames are carried along it, the moment is that of
/// bending; the force at a place is the last end's pull and what presses on the rod between there and that end. EI = 1.
/// @param first  frame of the first place
/// @param loads  by increasing s
chain::Piece without_torsion(const std::vector<CurvePlace>& places, const rod::Quaternion& first,
                             const Eigen::Vector3d& pull, const std::vector<discrete_rod::PointLoad>& loads);

}  // namespace windlass::equilibrium
