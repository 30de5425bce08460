#include "app/run_command.hpp"

namespace windlass::app {

void add_report(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand("report", "one self-contained interactive HTML file");
  command->footer("Goes to RUN/report.html unless --out says otherwise.");
  add_run(*command, common, status, run_report);
  add_common_options(*command, common);
}

}  // namespace windlass::app
