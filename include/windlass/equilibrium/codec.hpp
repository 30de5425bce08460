#pragma once

#include <continuation/checkpoint.hpp>
#include <string>
#include <vector>

#include "windlass/scene/scene.hpp"

namespace windlass::equilibrium {

/// Rod problems of one scene as data, for checkpoints. The scene's loads and other parameters may differ from those of
/// the encoded problem as long as the keys name them: they come with the state.
continuation::ProblemCodec rod_codec(const scene::Scene& scene, const std::vector<std::string>& keys);

}  // namespace windlass::equilibrium
