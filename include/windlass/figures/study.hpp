#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"

/// The figures of Sabater, Park, Crassous, Neukirch & Reis, "Frictional sliding strength of knotted and capstan
/// configurations along the axis of a cylinder", as far as the models here can make them, from computations made here.
namespace windlass::figures {

/// A computation the figures are drawn from: one `windlass diagram` or `windlass continue`.
struct PlannedRun {
  std::string name;                   ///< of its folder
  std::string scene;                  ///< file stem of a shipped scene
  std::vector<std::string> settings;  ///< KEY=VALUE
  bool diagram = true;                ///< else one branch
  bool may_end = false;               ///< early: how far the branch goes is what is asked
};

std::vector<PlannedRun> planned_runs();

/// The words to type for it. @param scenes  folder of the shipped scenes as the user writes it
std::string command_of(const PlannedRun& plan, const std::string& scenes, const std::string& out);

/// A finished computation.
struct StudyRun {
  scene::Scene scene;
  output::Run run;
  std::string command;

  double phi() const { return scene.load.angle; }
  /// Tension of the first special point of that type on the flat branch [EI/ρ²]; nullopt where there is none.
  std::optional<double> flat_event(const std::string& type) const;
  /// The stable state at a tension, continued there from the stored points (output::stable_state).
  /// @throws std::runtime_error where there is none
  equilibrium::Solution stable_state(double tension) const;
  /// R_tot [EI/ρ²] and dlog R_tot/dlog T of that state.
  double stable_force(double tension) const;
  double stable_log_slope(double tension) const { return log_slope_with_error(tension).value; }

  struct LogSlope {
    double value,
        error;  ///< the error is that of the difference, from two steps: large beside a change of contact
  };
  LogSlope log_slope_with_error(double tension) const;
};

using Study = std::map<std::string, StudyRun>;

}  // namespace windlass::figures
