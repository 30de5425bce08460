#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "windlass/chain/chain.hpp"

/// Contact topologies and the chains built from them.
namespace windlass::chain {

/// State of a stretch of rod: line contact, free between contacts, free to the end.
enum class Stretch { line, gap, tail };

/// Gaps in a line contact too small for arcs of their own (equilibrium/micro_gap.hpp): the line goes on through them,
/// with suction.
struct MicroGaps {
  bool begin =
      false;  ///< beside the touch at the line's begin; about the mid-point where the line begins there
  bool end = false;  ///< the same at its end
  int inside = 0;
  bool any() const { return begin || end || inside > 0; }
  MicroGaps reversed() const { return {end, begin, inside}; }
  bool operator==(const MicroGaps&) const = default;
};

/// The sequence of contacts, from the mid-point outward; joints follow from it (line–free: edge, free–free: touch).
///
/// A half chain uses `right` only. `mid_touch`: the mid-point itself touches (both first stretches are then free).
struct Topology {
  std::vector<Stretch> right, left;
  bool half = true;
  bool mid_touch = false;
  std::vector<MicroGaps> micro_gaps = {};  ///< one a link of the chain; empty where there are none

  MicroGaps micro_gaps_of(int link) const { return micro_gaps.empty() ? MicroGaps{} : micro_gaps[link]; }
  /// Keeps `micro_gaps` empty where there are none.
  void set_micro_gaps(std::vector<MicroGaps> gaps);
  /// Whole rod, e.g. "tail touch gap line gap touch tail".
  std::string text() const;
  bool contact() const;
  bool operator==(const Topology&) const = default;
};

/// What else a chain is made of.
struct RodKind {
  bool spatial = false;
  bool clamped = false;       ///< ends clamped (else free of moment)
  bool infinite = false;      ///< closed-form tails
  bool strut = false;         ///< no cylinder: clamped along e_x
  bool under_thrust = false;  ///< strut: thrust given, else shortening
  double pull_angle =
      NAN;  ///< between the pulls, for a rod that they leave free to turn [rad]; NaN: it varies
  double bending_stiffness = 1.0;
  Eigen::Vector3d stiffness = {1.0, 1.0, 2.0 / 3.0};
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();
  bool isotropic_straight() const { return stiffness(0) == stiffness(1) && natural.isZero(); }
};

/// Mesh of one arc in scaled arclength, [0, …, 1], and its number of stages.
struct ArcMesh {
  std::vector<double> nodes = {0.0, 1.0};
  int stages = 6;
};

/// @param meshes  one an arc, in the order of the chain (full chain: from s = −L/2); ignored for closed-form arcs
/// @throws std::invalid_argument for a topology the kind of rod cannot have
std::unique_ptr<Chain> build_chain(const RodKind& rod, const Topology& topology,
                                   const std::vector<ArcMesh>& meshes);

/// Stretches in the order of the chain's links.
std::vector<Stretch> stretches(const Topology& topology);

}  // namespace windlass::chain
