#include "app/run_command.hpp"

namespace windlass::app {

void add_fit(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("fit", "the friction coefficient from measured sliding strengths");
  command.footer(
      "DATA is a CSV file with the columns T, F0 and, if wanted, F0_error. Units stand in the header:\n"
      "  T [g], F0 [N], F0_error [N]\n"
      "  200, 1.93, 0.05\n"
      "Any force or hung mass will do; without units the columns are dimensionless, in EI/rho^2.\n"
      "RUN is a branch or diagram in load.tension. "
      "The least squares fit of F0 = mu R_tot(T) takes R_tot of the run's stable state at each measured T. "
      "Where\n"
      "the cylinder slides (cylinder.sliding) F0 is that of the dragged state, followed in the friction "
      "coefficient.\n"
      "The weights are 1/F0_error^2 where the file gives errors. Otherwise every F0 has the same error, so "
      "that "
      "high\n"
      "tensions decide (a ratio F0/R_tot counts like R_tot^2), or with --weights relative every ratio counts "
      "the "
      "same.\n"
      "Pictures go into RUN/fit unless --out says otherwise.");
  const auto request = add_run(command, common, status, run_fit);
  command.add("--csv", request->csv, "measured points").required().type("DATA");
  command.add("--weights", request->weights, "automatic, absolute or relative")
      .one_of({"automatic", "absolute", "relative"})
      .default_shown();
  command.add("--min-tension", request->min_tension, "leave out points below, e.g. 3 or \"500 g\"").type("T");
  add_format_option(command, request->formats);
  add_common_options(command, common);
}

}  // namespace windlass::app
