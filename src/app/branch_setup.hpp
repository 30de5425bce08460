#pragma once

#include <continuation/options.hpp>

#include "app/commands.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::app {

/// Where a branch starts and how it is walked, from a scene or from a stored point.
struct BranchSetup {
  equilibrium::Started start;
  continuation::Options options;
};

/// @throws InputError when the scene has no [continuation], or the stored point does not exist
BranchSetup set_up_branch(const BranchRequest& request);

/// Opens the run folder the request asks for.
output::RunWriter open_run(const BranchRequest& request, const std::string& command);

}  // namespace windlass::app
