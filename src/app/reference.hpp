#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// What can be said about the command line, from the one place that declares it.
namespace windlass::app {

/// A manual page (roff, man macros): every command with its options and notes, and every scene key.
std::string manual_page(const CLI::App& app);

/// A completion script for bash: commands, options, their choices, scene files, run folders, labels and scene keys.
std::string bash_completion(const CLI::App& app);

/// Words an option accepts; empty where it is not a choice.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace windlass::app
