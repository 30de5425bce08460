#pragma once

#include <continuation/diagram.hpp>
#include <string>

#include "app/commands.hpp"

namespace windlass::app {

/// Walks the branches a request asks for into its run folder, or goes on with the run that is there.
/// @return exit status
int run_branches(const BranchRequest& request, const std::string& command,
                 const continuation::DiagramOptions& limits);

}  // namespace windlass::app
