#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "windlass/chain/chain.hpp"

/// Contact topologies and the chains built from them.
namespace windlass::chain {

/// State of a stretch of rod: line contact, free between contacts, free to the end.
enum class Stretch { line, gap, tail };

/// The sequence of contacts, from the mid-point outward; joints follow from it (line–free: edge, free–free: touch).
///
/// A half chain uses `right` only. `mid_touch`: the mid-point itself touches (both first stretches are then free).
struct Topology {
  std::vector<Stretch> right, left;
  bool half = true;
  bool mid_touch = false;

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
