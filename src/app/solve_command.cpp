#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_solve(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("solve", "one equilibrium at the scene's parameters");
  command.footer("Writes a run folder only where --out asks for one.");
  const auto path = std::make_shared<std::string>();
  command.add("SCENE", *path, "scene file (TOML)").required().type("");
  add_common_options(command, common);
  command.run([path, &common, &status] {
    status = run_solve({common, scene::read_scene(*path, common.set), !common.out.empty()});
  });
}

}  // namespace windlass::app
