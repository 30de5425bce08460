#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/pull_folder.hpp"
#include "windlass/pull/outcome.hpp"

namespace windlass::app {

/// What a pull came to, beside the steady states of `solve`.
struct PullResult {
  std::vector<PulledMesh> meshes;                      ///< natural units
  std::vector<std::optional<pull::Plateau>> plateaus;  ///< of each
  std::vector<equilibrium::StateSummary> states;       ///< steady ones, as given
  bool own = false;                                    ///< the last of them was found from the plateau
  std::string not_polished;                            ///< why it was not, where it was tried
  std::string no_states;                               ///< why there are none
  std::optional<pull::Limit> limit;                    ///< natural units
  std::optional<pull::Selection> selection;            ///< of `states`
  double force = 1.0;                                  ///< natural unit of force [EI/ρ²]
  std::string failure;                                 ///< of the last mesh; empty where it went through

  std::vector<pull::MeshOutcome> outcomes() const;
  std::vector<double> jumps(std::size_t mesh) const;  ///< displacements [ρ]
};

nlohmann::ordered_json to_json(const PullResult& result, const scene::Scene& scene);
void print(const PullResult& result, const scene::Scene& scene);

}  // namespace windlass::app
