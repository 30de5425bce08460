#pragma once

#include "windlass/chain/profile.hpp"

/// The contacts of a state as seen from outside, and their forces.
namespace windlass::chain {

/// Fills in the contacts of a profile whose pieces are there, and counts the turns of its free pieces from them.
void add_contacts(const Chain& chain, const Topology& topology, const VectorXd& x, const Loads& loads,
                  Profile& profile);

/// How often a contact counts on the whole rod.
double copies(const Topology& topology, int joint);

/// Internal force before a joint; at the mid-point of a half chain the image of the force behind.
Eigen::Vector3d force_before(const Topology& topology, int joint, const Eigen::Vector3d& before,
                             const Eigen::Vector3d& after);

/// Force of another strand on a joint.
Eigen::Vector3d strand_push(const Chain& chain, const VectorXd& x, int joint);

}  // namespace windlass::chain
