#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// States of a rod that a cylinder slips along and a plate holds back (PHYSICS, "Steady sliding").
namespace windlass::equilibrium {

/// The flat coil, which lies on the plate along its whole contact; in the plane where the coil is no line contact.
/// @throws NoEquilibrium
Started flat_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys);

/// The same of a rod of any thickness: one whose tails cross has the right one in the plate, and the left one below it.
/// @throws NoEquilibrium
Started coil_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys);

/// A state without friction, put under the plate: its highest tail touches the plate, and the rest of that tail lies flat in it.
/// The cylinder drags by a little friction; continuation in it leads to the scene's.
/// @param still    in contact with the cylinder only; one or both of its tails rise to its highest place
/// @param failure  why there is none
std::optional<Started> under_the_plate(const Started& still, const scene::Scene& scene, double friction,
                                       std::string& failure);

/// Coils that hang from the plate on both sides, mirror images of themselves, which nothing without friction leads to: from the
/// flat coil bent down, on touches of the cylinder at its outermost contacts and in the middle. Half chains where the scene asks
/// for the symmetry, full ones elsewhere.
std::vector<Started> hanging_arches(const scene::Scene& scene, const std::vector<std::string>& keys);

/// States that the frictionless ones of this tension lead to as the friction grows, of rods on one plate under dead pulls.
/// @param searched  for people: what was followed
std::vector<Started> left_the_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched);

/// States that have left the plate but for some places, at the scene's friction: those that the states without
/// friction lead to as the friction grows from next to nothing, through folds.
/// @param searched  for people: what was followed
std::vector<Started> dragged_states(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched);

}  // namespace windlass::equilibrium
