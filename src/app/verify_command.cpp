#include "app/run_command.hpp"

namespace windlass::app {

void add_verify(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command =
      app.add_subcommand("verify", "the certificate: every stored point integrated again with CVODE");
  command->footer(
      "Reports the largest mismatch at joints, the drift of the invariants, the force balance, the worst gap "
      "and the smallest contact force. Exit status 3 if a point fails.");
  const auto request = add_run(*command, common, status, run_verify);
  command
      ->add_option("--tolerance", request->standard.tolerance,
                   "relative tolerance of the reference integration")
      ->check(CLI::Range(1e-15, 1e-3))
      ->capture_default_str();
  command->add_option("--accept", request->standard.accept, "largest defect that passes")
      ->check(CLI::Range(1e-15, 1.0))
      ->capture_default_str();
  add_common_options(*command, common);
}

}  // namespace windlass::app
