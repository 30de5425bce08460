#include "windlass/figures/study.hpp"

#include <cmath>
#include <stdexcept>

#include "knot_runs.hpp"
#include "sliding_data.hpp"
#include "thick_runs.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::figures {

std::vector<PlannedRun> planned_runs() {
  // From well inside the linear regime down to loose coils, in steps that show every bend of a curve on paper.
  const std::vector<std::string> sweep{"continuation.from=40", "continuation.to=0.1",
                                       "continuation.step_max=0.03"};
  std::vector<PlannedRun> runs;
  for (const char* angle : {"quarter-pi", "half-pi", "pi", "2pi", "4pi"})
    runs.push_back({angle, std::string("capstan-") + angle, sweep, true});
  runs.push_back({"2pi-clamped", "capstan-2pi-clamped", {}, true});
  for (int throws = 2; throws <= 6; ++throws) {
    const std::string turns = std::to_string(2 * throws);
    runs.push_back({"knot-" + std::to_string(throws),
                    "capstan-4pi",
                    {"model.kind=planar", "load.angle=" + turns + " pi", "rod.length=inf",
                     "continuation.from=10", "continuation.to=0.5", "continuation.step_max=0.05"},
                    false});
  }
  for (PlannedRun& run : thick_runs()) runs.push_back(std::move(run));
  for (PlannedRun& run : knot_runs()) runs.push_back(std::move(run));
  for (PlannedRun& run : sliding_hitch_runs()) runs.push_back(std::move(run));
  for (PlannedRun& run : sliding_runs()) runs.push_back(std::move(run));
  return runs;
}

std::string command_of(const PlannedRun& plan, const std::string& scenes, const std::string& out) {
  std::string text = std::string("windlass ") + (plan.diagram ? "diagram " : "continue ") + scenes + "/" +
                     plan.scene + ".toml";
  for (const std::string& setting : plan.settings)
    text += " --set " + (setting.find(' ') == std::string::npos ? setting : "\"" + setting + "\"");
  return text + " --out " + out;
}

std::optional<double> StudyRun::flat_event(const std::string& type) const {
  for (const auto& point : run.special_points)
    if (point.branch == 1 && point.type == type) return point.T;
  return std::nullopt;
}

equilibrium::Solution StudyRun::stable_state(double tension) const {
  if (const auto state = output::stable_state(run, scene, tension)) return *state;
  throw std::runtime_error(scene.name + ": no stable state was found at T = " + std::to_string(tension));
}

double StudyRun::stable_force(double tension) const { return stable_state(tension).R_tot; }

StudyRun::LogSlope StudyRun::log_slope_with_error(double tension) const {
  // Central differences: truncation of order 1e-6, and the forces are good to 1e-8. What that does to a slope is seen in how far
  // two more steps are off the parabola, in the step, of the first two: touches that stand for lines may be laid anew on the way.
  constexpr double step = 2e-3;
  const auto difference = [&](double h) {
    return std::log(stable_force(tension * std::exp(h)) / stable_force(tension * std::exp(-h))) / (2.0 * h);
  };
  const double value = difference(step), bend = (difference(2.0 * step) - value) / 3.0;
  double noise = 0.0;
  for (const double part : {0.75, 1.5})
    noise = std::max(noise, std::abs(difference(part * step) - value - (part * part - 1.0) * bend));
  return {value, std::abs(bend) + noise};
}

}  // namespace windlass::figures
