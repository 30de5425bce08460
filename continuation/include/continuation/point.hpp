#pragma once

#include <memory>
#include <string>
#include <vector>

#include "continuation/branch_point.hpp"

namespace continuation {

enum class PointType { start, regular, fold, branch_point, event, end, hopf, function };

/// The enumerator's own name.
const char* name(PointType type);

/// One accepted or located solution of a branch.
struct Point {
  /// Regular points share the walker's live problem, which fits x until the next step (which may adapt it);
  /// special points own a clone, so that they can be restarted from at any time.
  std::shared_ptr<Problem> problem;
  Vector x, p;
  Tangent tangent;  ///< unit, in the direction of travel
  PointType type = PointType::regular;
  double path_length = 0.0;  ///< since the start
  double ds = 0.0;           ///< path length since the last accepted point
  int newton_iterations = 0;
  int index = -1;                 ///< at a special point: before it; -1: unknown
  int index_after = -1;           ///< at a special point: after it
  std::vector<double> functions;  ///< values of Options::functions

  // Special points only.
  std::string label;                                ///< "F1", "B1", "E1" ..., given by trace_diagram
  std::string event;                                ///< name of the event function or user function
  std::string before, after;                        ///< the two descriptions of a Transition
  std::string note;                                 ///< e.g. why a branch point was not polished
  double precision = 0.0;                           ///< of the varied parameter
  double bracket_lo = 0.0;                          ///< path lengths between which
  double bracket_hi = 0.0;                          ///< the point was shut in
  int multiplicity = 0;                             ///< of a branch point: dimension of the kernel
  std::shared_ptr<const BranchPoint> branch_point;  ///< null vectors and tangents, where polished
  bool breaking = false;  ///< its kernel breaks the symmetry of the walked problem: see Problem::unrestricted
  std::shared_ptr<Problem> next_problem;  ///< beyond an event; null if the branch ends there or is lost
  Vector next_x;                          ///< its corrected state
  Vector next_p;
};

/// Why a walk is over.
struct End {
  enum class Kind { none, target, bound, event, closed, joined, max_points, stopped, lost, function };
  Kind kind = Kind::none;
  std::string reason;  ///< readable; for `lost` it says what failed

  explicit operator bool() const { return kind != Kind::none; }
  bool lost() const { return kind == Kind::lost; }
};

}  // namespace continuation
