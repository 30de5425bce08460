#pragma once

#include <vector>

#include "windlass/discrete_rod/thick_minimiser.hpp"

/// What a minimum of the thick discrete rod touches, as seen on its half s >= 0.
namespace windlass::discrete_rod {

/// A stretch that lies on the cylinder.
struct LyingStretch {
  double begin = 0.0, end = 0.0;  ///< as long as the bed is pressed on [ρ]
};

/// A place where two strands press on each other hardest.
struct StrandTouch {
  double s = 0.0, other = 0.0;  ///< s <= other, both on this half [ρ]
  bool mirrored = false;        ///< the other strand is the half-turn's image of this half
  bool own_image =
      false;          ///< and the place is its own partner; of a line all from s to `other` is its own image
  bool line = false;  ///< pressed on all the way from one place to the other
};

/// A force on the rod at a place, one of those that make up the contact densities.
struct PointLoad {
  double s = 0.0;
  Eigen::Vector3d force;  ///< [EI/ρ²]
};

struct ThickContacts {
  std::vector<LyingStretch> cylinder;  ///< by increasing s
  std::vector<StrandTouch> strands;
  std::vector<PointLoad> loads;  ///< by increasing s
  double range = 0.0;            ///< over which bed and strands smear a point force [ρ]
};

/// The same in a unit of length that is smaller by this factor.
ThickContacts scaled(ThickContacts contacts, double factor);

/// @param lines  is a stretch along which a strand is pressed on by its own image a line, or the hardest of it a touch? The smeared
///               contact does not tell
ThickContacts contacts_of(const ThickRod& rod, const ThickMinimum& minimum, bool lines = false);

}  // namespace windlass::discrete_rod
