#pragma once

#include <string>

#include "app/command_line.hpp"

/// What can be said about the command line, from the one place that declares it.
namespace windlass::app {

/// A manual page (roff, man macros): every command with its options and notes, and every scene key.
std::string manual_page(const CommandLine& app);

/// A completion script for bash: commands, options, their choices, scene files, run folders, labels and scene keys.
std::string bash_completion(const CommandLine& app);

}  // namespace windlass::app
