#pragma once

#include <functional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

/// What dragged states of a simpler rod are followed in, on the same contacts, until they are those of a scene.
struct Further {
  scene::Scene simpler;  ///< whose dragged states are sought
  scene::Scene from;     ///< the scene at the beginning of what follows, whose states are the simpler one's
  std::vector<std::string> keys;                      ///< of the parameter
  double to = 0.0;                                    ///< its value in the scene
  std::function<bool(const Topology&)> carries = {};  ///< are the equations built for these contacts?
  std::string what = {};                              ///< for people: the parameter with its value
  std::string not_carried = {};                       ///< and why a state that lies along lines is left out
};

/// @param searched  for people: what was followed, and what was not
std::vector<Started> dragged_further(const scene::Scene& scene, const Further& further,
                                     const std::vector<std::string>& keys, std::string& searched);

}  // namespace windlass::equilibrium
