#include "app/run_command.hpp"

namespace windlass::app {

void add_stability(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand("stability", "eigenvalues, index and modes of stored points");
  command->footer(
      "The index is the number of negative eigenvalues of the second variation: 0 means stable. It is "
      "counted twice, by SLEPc and by the inertia of a factorisation.");
  const auto request = add_run(*command, common, status, run_stability);
  command->add_option("LABEL", request->label, "a stored point, e.g. B1 (default: all)")->type_name("");
  command->add_option("--eigenvalues", request->eigenvalues, "how many of the lowest")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  add_common_options(*command, common);
}

}  // namespace windlass::app
