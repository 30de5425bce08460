#include "windlass/output/stable_state.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/follow.hpp"

namespace windlass::output {

namespace {

double highest_tension(const Run& run) {
  double highest = 0.0;
  for (const BranchRow& row : run.rows) highest = std::max(highest, row.T);
  return highest;
}

/// Pairs of consecutive rows of the stretch with the tension between them.
std::vector<std::pair<const BranchRow*, const BranchRow*>> brackets(const Run& run,
                                                                    const StableStretch& stretch,
                                                                    double tension) {
  std::vector<std::pair<const BranchRow*, const BranchRow*>> pairs;
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    const BranchRow &a = run.rows[i], &b = run.rows[i + 1];
    if ((a.T - tension) * (b.T - tension) <= 0.0) pairs.emplace_back(&a, &b);
  }
  return pairs;
}

std::optional<StableStretch> stretch_at(const Run& run, double tension) {
  for (const StableStretch& stretch : stable_stretches(run))
    if (stretch.lowest <= tension && tension <= stretch.highest) return stretch;
  return std::nullopt;
}

/// Rows from which the state may be reached along a stable stretch, nearest first.
std::vector<const BranchRow*> neighbours(const Run& run, double tension) {
  std::vector<const BranchRow*> found;
  if (tension > highest_tension(run)) {
    for (const BranchRow& row : run.rows)
      if (row.T == highest_tension(run) && row.index == 0) found.push_back(&row);
  } else if (const auto stretch = stretch_at(run, tension)) {
    for (const auto& [a, b] : brackets(run, *stretch, tension)) found.insert(found.end(), {a, b});
  }
  std::erase_if(found, [&](const BranchRow* row) {
    return !run.points.find(point_name(row->branch, row->point, row->label));
  });
  std::stable_sort(found.begin(), found.end(), [&](const BranchRow* a, const BranchRow* b) {
    if (a->label.empty() != b->label.empty()) return a->label.empty();  // special points are singular
    return std::abs(std::log(a->T / tension)) < std::abs(std::log(b->T / tension));
  });
  constexpr std::size_t enough = 4;
  if (found.size() > enough) found.resize(enough);
  return found;
}

}  // namespace

std::vector<StableStretch> stable_stretches(const Run& run) {
  std::vector<StableStretch> stretches;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const BranchRow &a = run.rows[i - 1], &b = run.rows[i];
    if (a.branch != b.branch || index_between(a, b) != 0) continue;
    if (stretches.empty() || stretches.back().last != i - 1) stretches.push_back({i - 1, i, a.T, a.T});
    StableStretch& stretch = stretches.back();
    stretch.last = i;
    stretch.lowest = std::min(stretch.lowest, b.T);
    stretch.highest = std::max(stretch.highest, b.T);
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const StableStretch& a, const StableStretch& b) { return a.highest > b.highest; });
  return stretches;
}

std::optional<equilibrium::Solution> stable_state(const Run& run, const scene::Scene& scene, double tension) {
  for (const BranchRow* row : neighbours(run, tension)) {
    try {
      const equilibrium::Solution stored = run.points.get(point_name(row->branch, row->point, row->label));
      equilibrium::Solution solution = equilibrium::follow(scene, stored, "load.tension", tension);
      // No count of directions knows a dragged state's stability: that of the stored points beside it stands.
      if (solution.stability->index == 0 || solution.dragged) return solution;
    } catch (const std::runtime_error&) {  // lost on the way: the next neighbour may do better
    }
  }
  return std::nullopt;
}

std::optional<StableForce> stable_contact_force(const Run& run, const scene::Scene& scene, double tension) {
  if (const auto state = stable_state(run, scene, tension))
    return StableForce{state->R_tot,
                       tension > highest_tension(run) ? ForceSource::above_run : ForceSource::computed};
  const auto stretch = stretch_at(run, tension);
  if (!stretch) return std::nullopt;
  for (const auto& [a, b] : brackets(run, *stretch, tension)) {
    const double width = std::log(b->T / a->T);
    if (std::abs(width) > 0.1 || !(a->R_tot > 0.0) || !(b->R_tot > 0.0)) continue;
    const double part = width == 0.0 ? 0.0 : std::log(tension / a->T) / width;
    return StableForce{a->R_tot * std::pow(b->R_tot / a->R_tot, part), ForceSource::interpolated};
  }
  return std::nullopt;
}

}  // namespace windlass::output
