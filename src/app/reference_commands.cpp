#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/commands.hpp"
#include "app/reference.hpp"

namespace windlass::app {

void add_manual(CLI::App& app, CommonOptions&, int& status) {
  CLI::App* command = app.add_subcommand("manual", "this reference as a manual page");
  command->footer("Read it with\n  windlass manual | man -l -");
  command->callback([&app, &status] {
    std::fputs(manual_page(app).c_str(), stdout);
    status = done;
  });
}

void add_completion(CLI::App& app, CommonOptions&, int& status) {
  CLI::App* command = app.add_subcommand("completion", "a completion script for bash");
  command->footer("In the shell, or in ~/.bashrc:\n  source <(windlass completion)");
  command->callback([&app, &status] {
    std::fputs(bash_completion(app).c_str(), stdout);
    status = done;
  });
}

}  // namespace windlass::app
