#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

void add_plot(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command =
      app.add_subcommand("plot", "pictures: diagram, contact force, rod shapes (PNG, SVG, PDF)");
  command->footer("Needs gnuplot. Pictures go into RUN/plots unless --out says otherwise.");
  const auto request = std::make_shared<RunRequest>();
  command->add_option("RUN", request->run, "run folder")->required()->type_name("");
  add_format_option(*command, request->formats);
  command
      ->add_option("--csv", request->csv,
                   "measured points (T, F0) to lay over the diagram; see `windlass fit --help`")
      ->type_name("DATA");
  add_common_options(*command, common);
  command->callback([request, &common, &status] {
    request->common = common;
    scene_of_run(request->run, common);  // tells a folder that is no run from one that is
    status = run_plot(*request);
  });
}

}  // namespace windlass::app
