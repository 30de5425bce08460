#include "app/run_command.hpp"

namespace windlass::app {

void add_verify(CommandLine& app, CommonOptions& common, int& status) {
  Command command =
      app.add_command("verify", "the certificate: every stored point integrated again with CVODE");
  command.footer(
      "Reports the largest mismatch at joints, the drift of the invariants, the force balance, the worst gap "
      "and the smallest contact force. Exit status 3 if a point fails.");
  const auto request = add_run(command, common, status, run_verify);
  command.add("--tolerance", request->standard.tolerance, "relative tolerance of the reference integration")
      .between(1e-15, 1e-3)
      .default_shown();
  command.add("--accept", request->standard.accept, "largest defect that passes")
      .between(1e-15, 1.0)
      .default_shown();
  add_common_options(command, common);
}

}  // namespace windlass::app
