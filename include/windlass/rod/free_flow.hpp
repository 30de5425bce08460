#pragma once

#include <Eigen/Dense>

#include "windlass/rod/line_contact.hpp"
#include "windlass/rod/quaternion.hpp"

/// A free rod as an initial-value problem: what lies between two places where the state is known to all digits.
namespace windlass::rod {

struct Section {
  Eigen::Vector3d r, m;  ///< centre line [ρ] and moment [EI/ρ], world frame
  Quaternion q;
};

/// The section a signed distance further along the rod, n the force at `from` [EI/ρ²]; error about 1e-13.
Section free_flow(const Section& from, const Eigen::Vector3d& n, const Material& rod, double distance);

}  // namespace windlass::rod
