#pragma once

#include <optional>
#include <span>
#include <string>

#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"
#include "windlass/stability/spectrum.hpp"

namespace windlass::app {

/// The run's scene with the loads, and the parameter that varied, of a stored point.
scene::Scene scene_of_point(scene::Scene scene, const output::Run& run, std::size_t position);

/// The same for the reader, as KEY=VALUE; nothing where only the loads vary.
std::optional<std::string> setting_of_point(const output::Run& run, const std::string& label);

/// Lowest eigenvalues, and with `modes` their modes, of a state that can be restarted. @throws as stability::analyse
equilibrium::Stability spectrum_of(const scene::Scene& scene, const equilibrium::Restart& restart, int count,
                                   bool modes, stability::SpectrumSolver& solver);

/// Indices of dragged states, which are known from their spectra only. @throws as stability::analyse
void add_indices(std::span<equilibrium::StateSummary> states, const scene::Scene& scene);

/// All equilibria of a scene with their indices; of a dragged one the answer is a stable state if one was found.
/// @throws as equilibrium::equilibria and stability::analyse
equilibrium::Equilibria judged_equilibria(const scene::Scene& asked);

/// The stored point's lowest eigenvalues and their modes. @throws as stability::analyse
equilibrium::Stability spectrum_of_point(const scene::Scene& scene, const output::Run& run,
                                         std::size_t position, int count, stability::SpectrumSolver& solver);

}  // namespace windlass::app
