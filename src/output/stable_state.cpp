#include "windlass/output/stable_state.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "windlass/equilibrium/follow.hpp"

namespace windlass::output {

namespace {

/// Rows from which the state may be reached along a stable stretch, nearest first.
std::vector<const BranchRow*> neighbours(const Run& run, double tension) {
  std::vector<const BranchRow*> found;
  const auto add = [&](const BranchRow& row) {
    if (run.points.find(point_name(row.branch, row.point, row.label))) found.push_back(&row);
  };
  const BranchRow* highest = nullptr;
  for (const BranchRow& row : run.rows)
    if (highest == nullptr || row.T > highest->T) highest = &row;
  if (highest != nullptr && tension > highest->T && highest->index == 0) add(*highest);
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const BranchRow &a = run.rows[i - 1], &b = run.rows[i];
    if (a.branch != b.branch || (a.T - tension) * (b.T - tension) > 0.0 || index_between(a, b) != 0) continue;
    add(a), add(b);
  }
  std::stable_sort(found.begin(), found.end(), [&](const BranchRow* a, const BranchRow* b) {
    if (a->label.empty() != b->label.empty()) return a->label.empty();  // special points are singular
    return std::abs(std::log(a->T / tension)) < std::abs(std::log(b->T / tension));
  });
  constexpr std::size_t enough = 4;
  if (found.size() > enough) found.resize(enough);
  return found;
}

}  // namespace

std::optional<equilibrium::Solution> stable_state(const Run& run, const scene::Scene& scene, double tension) {
  for (const BranchRow* row : neighbours(run, tension)) {
    try {
      const equilibrium::Solution stored = run.points.get(point_name(row->branch, row->point, row->label));
      equilibrium::Solution solution = equilibrium::follow(scene, stored, "load.tension", tension);
      if (solution.stability->index == 0) return solution;
    } catch (const std::runtime_error&) {  // lost on the way: the next neighbour may do better
    }
  }
  return std::nullopt;
}

std::optional<double> stable_contact_force(const Run& run, const scene::Scene& scene, double tension) {
  if (const auto state = stable_state(run, scene, tension)) return state->R_tot;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const BranchRow &a = run.rows[i - 1], &b = run.rows[i];
    if (a.branch != b.branch || (a.T - tension) * (b.T - tension) > 0.0 || index_between(a, b) != 0) continue;
    const double width = std::log(b.T / a.T);
    if (std::abs(width) > 0.1 || !(a.R_tot > 0.0) || !(b.R_tot > 0.0)) continue;
    return a.R_tot * std::pow(b.R_tot / a.R_tot, width == 0.0 ? 0.0 : std::log(tension / a.T) / width);
  }
  return std::nullopt;
}

}  // namespace windlass::output
