#include "app/run_command.hpp"

namespace windlass::app {

void add_stability(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("stability", "eigenvalues, index and modes of stored points");
  command.footer(
      "The index is the number of negative eigenvalues of the second variation: 0 means stable. It is "
      "counted twice, by SLEPc and by the inertia of a factorisation.");
  const auto request = add_run(command, common, status, run_stability);
  command.add("LABEL", request->label, "a stored point, e.g. B1 (default: all)").type("");
  command.add("--eigenvalues", request->eigenvalues, "how many of the lowest")
      .between(1, 100)
      .default_shown();
  add_common_options(command, common);
}

}  // namespace windlass::app
