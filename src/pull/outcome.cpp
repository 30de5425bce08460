#include "windlass/pull/outcome.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/discrete_rod/thick_minimiser.hpp"

namespace windlass::pull {

namespace {

constexpr int order = 3;  // in h, of the beds

}  // namespace

std::optional<Limit> limit_of(std::span<const MeshOutcome> meshes) {
  std::vector<double> h, drag, R_tot;
  for (const MeshOutcome& mesh : meshes) {
    if (!mesh.at) return std::nullopt;
    h.push_back(mesh.h), drag.push_back(mesh.at->drag), R_tot.push_back(mesh.at->R_tot);
  }
  if (h.empty()) return std::nullopt;
  if (h.size() == 1) return Limit{*meshes.front().at, 0.0};
  Limit out{{discrete_rod::extrapolated(h, drag, order), discrete_rod::extrapolated(h, R_tot, order)}, 0.0};
  // The line through the limit and the finest mesh: others are off it by what is not h³.
  const double slope = (drag.back() - out.at.drag) / std::pow(h.back(), order);
  for (std::size_t k = 0; k < h.size(); ++k) {
    const double off = drag[k] - out.at.drag - slope * std::pow(h[k], order);
    out.misfit = std::max(out.misfit, std::abs(off / out.at.drag));
  }
  return out;
}

std::optional<Selection> selected(const Plateau& at, std::span<const equilibrium::StateSummary> states,
                                  double force) {
  std::optional<Selection> out;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (!states[k].F0) continue;
    const double difference = at.drag * force / *states[k].F0 - 1.0;
    if (out && std::abs(out->difference) <= std::abs(difference)) continue;
    const bool agree =
        std::abs(difference) < same_state && std::abs(at.R_tot * force / states[k].R_tot - 1.0) < same_state;
    out = Selection{agree ? std::optional(k) : std::nullopt, k, difference};
  }
  return out;
}

}  // namespace windlass::pull
