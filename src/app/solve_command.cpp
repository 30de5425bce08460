#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_solve(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand("solve", "one equilibrium at the scene's parameters");
  command->footer("Writes a run folder only where --out asks for one.");
  const auto path = std::make_shared<std::string>();
  command->add_option("SCENE", *path, "scene file (TOML)")->required()->type_name("");
  add_common_options(*command, common);
  command->callback([path, &common, &status] {
    status = run_solve({common, scene::read_scene(*path, common.set), !common.out.empty()});
  });
}

}  // namespace windlass::app
