#pragma once

#include "check_list.hpp"
#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"
#include "windlass/verify/rod_flow.hpp"

/// The groups of checks that verify() runs, each on one aspect of a solution.
namespace windlass::verify {

inline constexpr double tight = Standard{}.accept;

Section sample(const equilibrium::ArcRecord& arc, Eigen::Index i);
Section first_section(const equilibrium::ArcRecord& arc);
Section last_section(const equilibrium::ArcRecord& arc);
/// Size of the difference of two frames; q and -q are the same frame.
double frame_distance(const Eigen::Vector4d& a, const Eigen::Vector4d& b);
/// The obstacle that a contact names, null where there is none of that number.
const Shape* shape_of(const std::vector<Shape>& shapes, int obstacle);

/// Does an arc lie at the height of the scene's plate? It takes the friction along e_z then.
bool on_plate(const equilibrium::ArcRecord& arc, const scene::Scene& scene);

/// Empty when counts, shapes, order of s and finiteness are right; otherwise what is wrong.
std::string structure_error(const equilibrium::Solution& solution);

/// Integrates every arc again: match at the samples, gap, pressure, contact force of line arcs.
/// @returns RodFlow::virial of the whole rod
double check_arcs(const equilibrium::Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list);
/// Continuity at the joints and the contact forces there.
void check_joints(const equilibrium::Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list);
/// Pulls and end kinds.
void check_ends(const equilibrium::Solution& solution, const scene::Scene& scene, const Scales& scales,
                CheckList& list);
/// Conserved quantities over the whole rod.
/// @param virial  that check_arcs() has found
void check_invariants(const equilibrium::Solution& solution, const scene::Scene& scene, const Scales& scales,
                      double virial, CheckList& list);
/// Agreement of the reported totals (R_tot, end_force, phi_star) with the stored rod.
void check_totals(const equilibrium::Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list);

}  // namespace windlass::verify
