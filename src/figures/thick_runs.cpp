#include "thick_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace windlass::figures {

namespace {

/// How often a word stands in a topology.
int count(std::string_view topology, std::string_view word) {
  int found = 0;
  for (std::size_t at = 0; (at = topology.find(word, at)) != std::string_view::npos; at += word.size())
    ++found;
  return found;
}

/// What stands in a topology, on the side of an event with fewer touches of strands and on the other.
struct Sides {
  int touches[2], lines[2], gaps[2];
};

Sides sides_of(const output::SpecialPoint& point) {
  const auto order = std::minmax(point.before, point.after, [](const auto& a, const auto& b) {
    return std::pair(count(a, "cross"), count(a, "line")) < std::pair(count(b, "cross"), count(b, "line"));
  });
  const auto both = [&](const char* word, int(&values)[2]) {
    values[0] = count(order.first, word), values[1] = count(order.second, word);
  };
  Sides sides;
  both("cross", sides.touches), both("line", sides.lines), both("gap", sides.gaps);
  return sides;
}

/// Angle round the axis along which the rod lies on the cylinder [rad].
double line_angle(const equilibrium::Solution& solution) {
  double angle = 0.0;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k)
    if (solution.arcs[k].kind == equilibrium::ArcKind::line)
      angle += std::abs(solution.joints[k + 1].angle - solution.joints[k].angle);
  return angle;
}

}  // namespace

std::string one_turn_run(const Thickness& thickness) { return std::string("thick-2pi-") + thickness.name; }
std::string two_turns_down_run(const Thickness& thickness) {
  return std::string("thick-4pi-") + thickness.name;
}
std::string two_turns_up_run(const Thickness& thickness) { return two_turns_down_run(thickness) + "-up"; }

std::vector<PlannedRun> thick_runs() {
  std::vector<PlannedRun> runs;
  for (const Thickness& thickness : thicknesses) {
    const auto plan = [&](const std::string& name, const char* scene, double from, double to) {
      runs.push_back(
          {name,
           scene,
           {fmt::format("rod.radius={}", thickness.radius()), fmt::format("continuation.from={}", from),
            fmt::format("continuation.to={}", to), "continuation.step_max=0.06",
            "continuation.max_points=400"},  // three hundred are enough where nothing holds it up
           false,
           true});
    };
    // Grown from the thin rod at the highest tension, which a stout rod reaches at a lower one only.
    constexpr double stout = 2.0;  // R/r
    plan(one_turn_run(thickness), "capstan-2pi-thick", thickness.ratio < stout ? 20.0 : 40.0,
         thickness.colour == nullptr ? 1.0 : 0.1);
    plan(two_turns_down_run(thickness), "capstan-4pi-thick", 2.0, 0.1);
    plan(two_turns_up_run(thickness), "capstan-4pi-thick", 2.0, 40.0);
  }
  return runs;
}

StrandEvents events_of(const std::vector<output::SpecialPoint>& points) {
  StrandEvents events;
  for (const output::SpecialPoint& point : points) {
    if (point.type != "contact") continue;
    const Sides s = sides_of(point);
    const bool more = s.touches[1] > s.touches[0];
    std::optional<double>* event = nullptr;
    if (s.touches[0] == 0 && more) event = &events.opens;
    if (s.touches[0] > 0 && more && s.gaps[0] != s.gaps[1]) event = &events.splits;
    if (s.touches[0] > 0 && more && s.gaps[0] == s.gaps[1]) event = &events.turns_meet;
    if (s.touches[0] > 0 && !more && s.lines[0] != s.lines[1]) event = &events.on_cylinder;
    if (event != nullptr && !*event) *event = point.T;  // the first: a branch may turn back beyond it
  }
  return events;
}

std::vector<TwoTurns> two_turns(const Study& study, const Thickness& thickness) {
  return states_of(study.at(two_turns_down_run(thickness)).run, study.at(two_turns_up_run(thickness)).run);
}

std::vector<TwoTurns> states_of(const output::Run& down, const output::Run& up) {
  std::vector<TwoTurns> states;
  const auto add = [&](const output::Run& run, const output::BranchRow& row) {
    const auto point = run.points.find(output::point_name(row.branch, row.point, row.label));
    if (!point || (!states.empty() && !(row.T > states.back().T))) return;
    states.push_back(
        {row.T, row.R_tot, 2.0 * row.phi_star, line_angle(run.points.get(*point)), row.topology});
  };
  for (auto row = down.rows.rbegin(); row != down.rows.rend(); ++row) add(down, *row);
  for (const output::BranchRow& row : up.rows) add(up, row);
  return states;
}

std::optional<TwoTurns> two_turns_at(const std::vector<TwoTurns>& states, double tension) {
  for (std::size_t i = 1; i < states.size(); ++i) {
    const TwoTurns &a = states[i - 1], &b = states[i];
    if (tension < a.T || tension > b.T) continue;
    const double x = std::log(tension / a.T) / std::log(b.T / a.T);
    return TwoTurns{tension, std::pow(a.R_tot, 1.0 - x) * std::pow(b.R_tot, x),
                    (1.0 - x) * a.wrapping + x * b.wrapping, (1.0 - x) * a.lines + x * b.lines, b.topology};
  }
  return std::nullopt;
}

}  // namespace windlass::figures
