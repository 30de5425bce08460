#include "app/run_command.hpp"

namespace windlass::app {

void add_report(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("report", "one self-contained interactive HTML file");
  command.footer("Goes to RUN/report.html unless --out says otherwise.");
  add_run(command, common, status, run_report);
  add_common_options(command, common);
}

}  // namespace windlass::app
