#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

void add_report(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand("report", "one self-contained interactive HTML file");
  command->footer("Goes to RUN/report.html unless --out says otherwise.");
  const auto request = std::make_shared<RunRequest>();
  command->add_option("RUN", request->run, "run folder")->required()->type_name("");
  add_common_options(*command, common);
  command->callback([request, &common, &status] {
    request->common = common;
    scene_of_run(request->run, common);  // tells a folder that is no run from one that is
    status = run_report(*request);
  });
}

}  // namespace windlass::app
