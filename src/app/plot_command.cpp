#include "app/run_command.hpp"

namespace windlass::app {

void add_plot(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("plot", "pictures: diagram, contact force, rod shapes (PNG, SVG, PDF)");
  command.footer("Needs gnuplot. Pictures go into RUN/plots unless --out says otherwise.");
  const auto request = add_run(command, common, status, run_plot);
  add_format_option(command, request->formats);
  command
      .add("--csv", request->csv,
           "measured points (T, F0) to lay over the diagram; see `windlass fit --help`")
      .type("DATA");
  add_common_options(command, common);
}

}  // namespace windlass::app
