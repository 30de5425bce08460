#pragma once

#include <memory>

#include "continuation/detect.hpp"
#include "continuation/point.hpp"

namespace continuation {

/// A walk between two steps, as data: a Walker made from it goes on, to the last bit, like the one it was
/// taken from (if the problem does; see ProblemCodec).
struct WalkState {
  std::shared_ptr<Problem> problem;
  Vector x, p;
  Tangent tangent;           ///< unit, in the direction of travel
  Tangent previous_tangent;  ///< at the point before
  double step = 0.0;         ///< of StepLength
  double usual_step = 0.0;   ///< of StepLength
  bool after_rejection = false;
  int index = -1, determinant = 0;                     ///< at (x, p); −1 and 0: unknown
  int complex_index = 0;                               ///< at (x, p)
  int breaking_index = -1;                             ///< at (x, p); −1: unknown
  std::optional<SmallEigenvalues> small;               ///< at (x, p)
  std::vector<EventFunction> events, previous_events;  ///< at (x, p) and at the point before
  double last_ds = 0.0;                                ///< path length between the two
  EventSigns signs;
  std::string noted;      ///< what the last event that passed said, and where: mirror images vanish together
  double noted_at = 0.0;  ///< parameter
  double path_length = 0.0;  ///< since the start
  int points = 0;            ///< accepted so far
  int events_in_place = 0;   ///< consecutive events without progress
  bool started = false, has_tangent = false;
  bool mesh_changed = false;  ///< since the start: states no longer compare entry by entry

  Vector start_x, start_fingerprint;  ///< to see a closed curve
  double start_parameter = 0.0, start_slope = 0.0;
  End end;
};

}  // namespace continuation
