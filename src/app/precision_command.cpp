#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_precision(CommandLine& app, CommonOptions& common, int& status) {
  Command command =
      app.add_command("precision", "error against time and unknowns, for every method that can do a scene");
  command.footer(
      "Errors are relative, against a reference of far higher resolution. Writes precision.csv, "
      "precision.json "
      "and the pictures\nprecision.{png,svg,pdf} (against seconds) and precision-unknowns to DIR (default "
      "runs/SCENE-NAME-precision).");
  struct Words {
    std::string scene;
    int repeats = 5;
    bool quick = false;
  };
  const auto words = std::make_shared<Words>();
  command.add("SCENE", words->scene, "scene file (TOML)").required().type("");
  command.add("--repeats", words->repeats, "solutions a measurement; the median counts").between(1, 1000);
  command.add_flag("--quick", words->quick, "short ladders");
  add_common_options(command, common);
  command.run([words, &common, &status] {
    status =
        run_precision({common, scene::read_scene(words->scene, common.set), words->repeats, words->quick});
  });
}

}  // namespace windlass::app
