#pragma once

#include <continuation/options.hpp>

#include "app/commands.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::app {

/// Where a branch starts and how it is walked, from a scene or from a stored point.
struct BranchSetup {
  scene::Scene scene;  ///< at the start
  std::string key;     ///< of the parameter that varies
  continuation::Options options;
  std::optional<equilibrium::Restart> stored;  ///< the stored point to start from
  bool singular = false;                       ///< it is a fold or a branch point
};

/// @throws InputError when the scene has no [continuation], or the stored point does not exist
BranchSetup set_up_branch(const BranchRequest& request);

struct FirstState {
  equilibrium::Started state;
  bool inside = false;  ///< of the branch, whose beginning, at the scene's parameter, is not found yet
};

/// The first equilibrium. @throws equilibrium::NoEquilibrium
FirstState first_state(const BranchSetup& setup);

}  // namespace windlass::app
