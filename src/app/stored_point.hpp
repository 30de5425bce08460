#pragma once

#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"
#include "windlass/stability/spectrum.hpp"

namespace windlass::app {

/// The run's scene with the loads, and the parameter that varied, of a stored point.
scene::Scene scene_of_point(scene::Scene scene, const output::Run& run, std::size_t position);

/// Its lowest eigenvalues and their modes. @throws as stability::analyse
equilibrium::Stability spectrum_of_point(const scene::Scene& scene, const output::Run& run,
                                         std::size_t position, int count, stability::SpectrumSolver& solver);

}  // namespace windlass::app
