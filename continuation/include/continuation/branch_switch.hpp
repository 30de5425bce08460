#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "continuation/point.hpp"

namespace continuation {

/// A branch that leaves a branch point: a solution on it close by, and the way on.
struct Arm {
  std::shared_ptr<Problem> problem;
  Vector x, p;
  Tangent tangent;       ///< away from the branch point
  double epsilon = 0.0;  ///< distance from the branch point along the arm's direction
  int count = 1;         ///< mirror images (equal fingerprints) this arm stands for
};

struct Arms {
  std::vector<Arm> arms;
  std::vector<std::string> failures;      ///< directions in which no arm was found, with the reason
  std::vector<std::string> inadmissible;  ///< arms on which an event function is negative from the start
};

/// All arms that leave a branch point, the branch it was found on excepted.
///
/// Simple points: both signs of the crossing tangent (pitchfork: ±φ; transcritical: the other branch).
/// Multiple points: both signs of the directions Problem::kernel_directions names, or for a double point without
/// names all rays of the bifurcation equations. Each start solves F = 0 with the distance ε along the direction
/// fixed and p free, for several ε until the solution lies along the direction and all its events are positive.
/// Arms with equal fingerprints are named once.
Arms switch_branch(const Point& branch_point, const Options& options);

/// Why an arm could not be started.
struct ArmFailure {
  std::string reason;
  bool inadmissible = false;  ///< the arm exists as a solution, but an event function is negative on it
};

/// One such start; nullopt with the reason if there is none.
std::optional<Arm> start_arm(const Point& branch_point, const Tangent& direction, double epsilon,
                             const Options& options, ArmFailure& failure);

/// rms(a − b) <= tolerance · max(unit, rms a), and equal lengths.
bool same_fingerprint(const Vector& a, const Vector& b, double tolerance, double unit = 1.0);

}  // namespace continuation
