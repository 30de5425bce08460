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
      "runs/SCENE-NAME-precision).\n"
      "Thick rods whose ends are free of moment get a second opinion besides: a discrete rod that shares no "
      "code "
      "with the\nchain, on several meshes, extrapolated; a table of R_tot and of the force between strands "
      "by "
      "both, second_opinion.csv.\nIts states: R/r = 1, 2.5, 5 times T from 1 to 12 (two turns and more: to "
      "8), "
      "or those of --tension and --radius;\nwith --quick the scene's own.");
  struct Words {
    std::string scene;
    int repeats = 5;
    bool quick = false;
    std::vector<double> tensions, radii;
  };
  const auto words = std::make_shared<Words>();
  command.add("SCENE", words->scene, "scene file (TOML)").required().type("");
  command.add("--repeats", words->repeats, "solutions a measurement; the median counts").between(1, 1000);
  command.add_flag("--quick", words->quick, "short ladders");
  command.add("--tension", words->tensions, "second opinion: at this T rho^2/EI").repeatable().positive();
  command.add("--radius", words->radii, "second opinion: of a rod of this r/rho")
      .repeatable()
      .between(1e-3, 0.999);
  add_common_options(command, common);
  command.run([words, &common, &status] {
    status = run_precision({common, scene::read_scene(words->scene, common.set), words->repeats, words->quick,
                            words->tensions, words->radii});
  });
}

}  // namespace windlass::app
