#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/figures/study.hpp"

/// Rods of several thicknesses: the runs that the figures on R/r are drawn from, and what is read from them.
namespace windlass::figures {

struct Thickness {
  double ratio;                                          ///< R/r
  const char* name;                                      ///< of it, in the names of runs
  const char* colour;                                    ///< of those in the paper; nullptr: only in the map
  double radius() const { return 1.0 / (1.0 + ratio); }  ///< r [ρ]
};
inline constexpr Thickness thicknesses[] = {
    {1.0, "1", "#d55e00"}, {1.5, "1.5", nullptr}, {2.5, "2.5", "#009e73"}, {4.0, "4", nullptr},
    {5.0, "5", "#0072b2"}, {7.0, "7", nullptr},   {10.0, "10", nullptr},   {15.0, "15", nullptr}};

/// Names in the study: one turn from high tension down, two turns down and up from where their branch can be started.
std::string one_turn_run(const Thickness& thickness);
std::string two_turns_down_run(const Thickness& thickness);
std::string two_turns_up_run(const Thickness& thickness);
std::vector<PlannedRun> thick_runs();

/// Tensions at which the contacts between strands change; nullopt where a run does not reach the event.
struct StrandEvents {
  std::optional<double> opens;   ///< no strand touches another below
  std::optional<double> splits;  ///< a touch becomes two above
  std::optional<double>
      on_cylinder;                   ///< of one turn: the strands touch where they lie on the cylinder, above
  std::optional<double> turns_meet;  ///< of two turns: neighbouring turns touch above
};
StrandEvents events_of(const std::vector<output::SpecialPoint>& points);

/// A state of two turns, or of a knot of as many.
struct TwoTurns {
  double T, R_tot;  ///< [EI/ρ²]
  double wrapping,
      lines;  ///< angle between the outermost contacts, and that along lines on the cylinder [rad]
  std::string topology;
};

/// Of both runs of two turns, from low tension up, to the highest or where the run ends.
std::vector<TwoTurns> two_turns(const Study& study, const Thickness& thickness);
/// Of two runs that start at one state, the first from there down in tension, the second up.
std::vector<TwoTurns> states_of(const output::Run& down, const output::Run& up);

/// Between the states, linear in log R_tot and log T, and in the angles; nullopt outside them.
std::optional<TwoTurns> two_turns_at(const std::vector<TwoTurns>& states, double tension);

}  // namespace windlass::figures
