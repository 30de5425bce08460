#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

void add_figures(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("figures", "the figures of the sliding-strength paper, computed here");
  command.footer(
      "Computes what the figures need from the shipped scenes (a run folder each, in OUT/runs), draws them "
      "with gnuplot, and\n"
      "writes OUT/index.html: each figure with its commands, and what agrees or disagrees with the paper. "
      "OUT is `figures`\n"
      "unless --out says otherwise. Branches that are lost on the way are reported on the page.");
  const auto formats =
      std::make_shared<std::vector<std::string>>(std::vector<std::string>{"png", "svg", "pdf"});
  add_format_option(command, *formats);
  add_common_options(command, common);
  command.run([formats, &common, &status] { status = run_figures({common, *formats}); });
}

}  // namespace windlass::app
