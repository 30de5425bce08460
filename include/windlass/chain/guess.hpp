#pragma once

#include "windlass/chain/profile.hpp"

/// Initial states for a chain: from any profile, and profiles known in closed form.
namespace windlass::chain {

/// State of `chain` whose joints sit at the arclengths `s` (one a joint) and which follows `profile`.
VectorXd guess_state(const Chain& chain, const Topology& topology, const RodKind& rod, const Profile& profile,
                     const std::vector<double>& s);

/// The whole rod of a half profile: its image under the symmetry, with s → −s, then the half itself.
Profile unfolded(const Profile& half, Symmetry symmetry);

/// Profile of the right half of the planar capstan with very long tails (PHYSICS, "Known exactly"): a line contact up to
/// phi_star, then the homoclinic tail; below the line-contact limit the coil is laid on the circle all the same.
/// @param half_length  where the profile ends; the tail is straight to rounding long before, if it is long
Profile capstan_profile(double tension, double angle, double half_length, double bending_stiffness);

/// Straight, uniformly twisted strut along e_x, with a sideways bow of size `bow` (an initial kick), s ∈ [0, half].
Profile strut_profile(const Loads& loads, double bow);

/// Mesh for a tail of `length` with a layer of width 1/sqrt(T) at its start, and evenly graded beyond.
std::vector<double> tail_mesh(double tension, double length, int elements, int stages);
std::vector<double> uniform_mesh(int elements);
/// A mesh of an arc of this size, elements longer than `longest` in equal parts; those of `whole` and more are left.
std::vector<double> split_mesh(const std::vector<double>& mesh, double size, double longest,
                               double whole = HUGE_VAL);

}  // namespace windlass::chain
