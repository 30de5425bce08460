#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "windlass/chain/chain.hpp"
#include "windlass/chain/coupling.hpp"
#include "windlass/chain/strands.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/line_contact.hpp"

/// Contact topologies and the chains built from them.
namespace windlass::chain {

/// State of a stretch of rod: line contact, free between contacts, free to the end.
enum class Stretch { line, gap, tail };

using contact::Symmetry;

/// What a joint touches: an obstacle, by its place in RodKind::obstacles, or another strand of the rod.
struct Seat {
  int obstacle = 0;
  /// 0: no strand. Two joints with the same size of it touch; with opposite signs the first touches the half-turn's image of
  /// the second; a joint alone with it touches its own image.
  int strand = 0;
  /// Inside a line between strands: where between its ends this touch is (chain/coupling.hpp).
  double part = 0.0;
  /// Touches with the same number stand for a line between strands, the second strand's with the opposite one; 0: no line, unless
  /// both strands lie on obstacles between touches that are next to each other.
  int line = 0;
  /// Of a place inside a line contact: the obstacle that stops it there, too (a plate); −1: none.
  int stop = -1;
  /// The line that begins here, or the touch that is here, lies on this obstacle, a plate, too; −1: on its own alone.
  int flat = -1;
  bool middle = false;  ///< of a stop: at s = 0, see contact::spatial::Stopped
  /// Of a line between strands where another contact presses on one of them: that strand's place is that of the touch before
  /// (−1) or behind (1), and the link between the two has no length; 0: it has a place of its own.
  int shares = 0;
  bool operator==(const Seat& other) const = default;
};

/// The sequence of contacts; joints follow from it (line–free: edge, free–free: touch).
///
/// Of a half chain, which `symmetry` maps to the other half, the stretches from s = 0 outward: the first spans both halves, unless
/// `mid_touch`: the rod then touches at s = 0. A full chain is the whole rod from s = −L/2, and knows no mid-point.
///
/// Contacts name what they touch: `on` has one entry a joint (a line's joints lie on the line's obstacle). Where it is empty
/// all lie on the first obstacle.
struct Topology {
  std::vector<Stretch> stretches;
  bool half = true;
  bool mid_touch = false;
  std::vector<Seat> on = {};
  Symmetry symmetry = Symmetry::half_turn;  ///< of a half chain

  Seat seat(int joint) const { return on.empty() ? Seat{} : on[joint]; }
  int obstacle(int joint) const { return seat(joint).obstacle; }
  /// Does a link lie on its obstacle and a plate at once?
  bool lies_flat(int link) const {
    return link >= 0 && link < static_cast<int>(stretches.size()) && stretches[link] == Stretch::line &&
           seat(link).flat >= 0;
  }
  /// Does the rod touch its obstacle and a plate at once at this joint, free on both sides?
  bool touches_flat(int joint) const {
    return (joint > 0 || (half && mid_touch)) && joint < static_cast<int>(stretches.size()) &&
           seat(joint).flat >= 0 && (joint == 0 || stretches[joint - 1] != Stretch::line) &&
           stretches[joint] != Stretch::line;
  }
  /// Does a line leave a plate at this joint, and go on along its own obstacle?
  bool lifts_off(int joint) const {
    return joint > 0 && joint < static_cast<int>(stretches.size()) && stretches[joint - 1] == Stretch::line &&
           stretches[joint] == Stretch::line && lies_flat(joint - 1) != lies_flat(joint);
  }
  /// The plate that an end of the rod touches, its place among the obstacles; 0: none.
  int end_touches(int joint) const {
    const bool end = joint == static_cast<int>(stretches.size()) || (joint == 0 && !half);
    return end ? seat(joint).obstacle : 0;
  }
  /// What a contact joint is pushed by: where a line is stopped, or lifts off, the plate.
  int pushed_by(int joint) const {
    if (seat(joint).stop >= 0) return seat(joint).stop;
    if (lifts_off(joint)) return std::max(seat(joint - 1).flat, seat(joint).flat);
    return seat(joint).obstacle;
  }
  std::vector<Coupling> couplings() const;
  /// Does a link begin or end where strands touch?
  bool beside_strand(int link) const { return seat(link).strand != 0 || seat(link + 1).strand != 0; }
  /// Whole rod, e.g. "tail touch gap line gap touch tail"; a contact on the second obstacle reads "touch:2", one with
  /// another strand "cross".
  std::string text() const;
  bool contact() const;
  bool operator==(const Topology& other) const;
};

/// The whole rod of a half chain.
Topology unfolded(const Topology& half);
/// The half chain of a whole rod whose contacts `symmetry` maps to themselves; the opposite of unfolded(), for rods that do not touch
/// themselves.
Topology folded(const Topology& whole, Symmetry symmetry);

/// How an end of the rod is held. Free rods: clamped or pinned. Rods round a cylinder: clamped, moment_free or spin_held.
enum class EndKind { moment_free, clamped, pinned, spin_held };

/// What else a chain is made of.
struct RodKind {
  bool spatial = false;
  EndKind left = EndKind::moment_free, right = EndKind::moment_free;
  bool infinite = false;      ///< closed-form tails
  bool strut = false;         ///< no cylinder, the ends on e_x
  bool under_thrust = false;  ///< strut: thrust given, else shortening
  bool knotted = false;       ///< strut: its ends are pulled, and long tails leave its knot to slide along it
  Travel travel = Travel::none;  ///< of a rod on a cylinder that slips along it
  bool coupled = false;          ///< its friction turns or stretches the rod: pressures of lines have layers
  bool guided = false;           ///< the ends of a rod on a cylinder are on sliders
  double pull_angle =
      NAN;  ///< between the pulls, for a rod that they leave free to turn [rad]; NaN: it varies
  double bending_stiffness = 1.0;  ///< B, of bending in the plane that the flat rod lies in
  /// Body frame: d₁ lies in that plane, so bending in it is about d₂ = −e_z: (B₂, B, C).
  Eigen::Vector3d stiffness = {1.0, 1.0, 2.0 / 3.0};
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();  ///< (0, −κ̂, τ̂), κ̂ > 0 bends the way round the cylinder
  double natural_curvature() const { return -natural(1); }
  obstacle::Set obstacles{{obstacle::unit_cylinder()}};
  /// Natural unit of lengths along the rod, which thresholds are relative to: ρ, or a twentieth of a free rod.
  double unit_length = 1.0;
  /// It may stretch: what its arcs are made for; how far is among the loads.
  bool extensible = false;
  /// It weighs in these directions, likewise.
  std::array<bool, 3> weighs = {false, false, false};
  bool weighs_at_all() const { return weighs[0] || weighs[1] || weighs[2]; }
  bool stretches() const { return extensible || weighs_at_all(); }
  rod::Material material() const {
    rod::Material rod{bending_stiffness, stiffness, natural};
    rod.stretches = stretches();
    return rod;
  }
  /// With what the loads say of it.
  rod::Material material(const Loads& loads) const {
    rod::Material rod = material();
    rod.compliance = loads.compliance;
    rod.weight = loads.weight();
    return rod;
  }
  /// Is an end kept from turning about its tangent, or altogether?
  bool holds_an_end() const {
    const auto held = [](EndKind kind) { return kind == EndKind::clamped || kind == EndKind::spin_held; };
    return held(left) || held(right);
  }
  bool isotropic_straight() const { return stiffness(0) == stiffness(1) && natural.isZero(); }
};

/// Mesh of one arc in scaled arclength, [0, …, 1], and its number of stages.
struct ArcMesh {
  std::vector<double> nodes = {0.0, 1.0};
  int stages = 6;
};

/// Does nothing but plates hold the rod along the axis of its cylinder? And does it touch none of them, so that it floats?
bool stands_free(const RodKind& rod);
bool floats(const RodKind& rod, const Topology& topology);

/// @param meshes  one an arc, in the order of the chain (full chain: from s = −L/2); ignored for closed-form arcs
/// @throws std::invalid_argument for a topology the kind of rod cannot have
std::unique_ptr<Chain> build_chain(const RodKind& rod, const Topology& topology,
                                   const std::vector<ArcMesh>& meshes);

}  // namespace windlass::chain
