#include <cstdio>

#include "app/commands.hpp"
#include "app/reference.hpp"

namespace windlass::app {

void add_manual(CommandLine& app, CommonOptions&, int& status) {
  Command command = app.add_command("manual", "this reference as a manual page");
  command.footer("Read it with\n  windlass manual | man -l -");
  command.run([&app, &status] {
    std::fputs(manual_page(app).c_str(), stdout);
    status = done;
  });
}

void add_completion(CommandLine& app, CommonOptions&, int& status) {
  Command command = app.add_command("completion", "a completion script for bash");
  command.footer("In the shell, or in ~/.bashrc:\n  source <(windlass completion)");
  command.run([&app, &status] {
    std::fputs(bash_completion(app).c_str(), stdout);
    status = done;
  });
}

}  // namespace windlass::app
