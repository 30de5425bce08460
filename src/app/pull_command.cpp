#include <memory>

#include "app/commands.hpp"
#include "windlass/pull/pull.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_pull(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command(
      "pull", "force against displacement from rest: a cylinder drawn through a rod that a plate holds back");
  command.footer(
      "Coulomb friction step by step on a discrete rod, from a relaxed frictionless state laid under the "
      "plate to "
      "the plateau,\nwhich is compared with the steady states that `solve` finds.\n"
      "  windlass pull data/scenes/capstan-2pi-plate.toml\n"
      "  windlass pull SCENE --set load.tension=0.57 --mesh 0.14 --mesh 0.1 --mesh 0.07\n"
      "DIR/pull.csv has a row a step and mesh, DIR/pull.png the curve; the plateau is extrapolated over the "
      "meshes. "
      "Ctrl-C stops\nafter the current step, --resume goes on. DIR is runs/SCENE-NAME-pull unless --out says "
      "otherwise.");
  struct Words {
    std::string scene;
    PullRequest request;
  };
  const auto words = std::make_shared<Words>();
  PullRequest& request = words->request;
  request.to = pull::usual_reach;
  command.add("SCENE", words->scene, "scene file (TOML) with cylinder.sliding").required().type("");
  command
      .add("--mesh", request.meshes,
           "length of the elements near the coil, in units of rod plus cylinder radius "
           "(repeatable; default 0.14, 0.1 and 0.07, over sqrt(T) where T > 1)")
      .type("H")
      .repeatable();
  command.add("--to", request.to, "largest displacement, in the same unit; the plateau ends a pull before")
      .between(1e-3, 1e4)
      .type("U")
      .default_shown();
  command.add("--step", request.step, "largest displacement a step")
      .between(1e-3, 1.0)
      .type("DU")
      .default_shown();
  add_format_option(command, request.formats);
  add_common_options(command, common);
  const Option resume =
      command.add_flag("--resume", request.resume, "go on with the pull in the folder --out");
  command.option("--force").excludes(resume);
  command.run([words, &common, &status] {
    words->request.common = common;
    words->request.scene = scene::read_scene(words->scene, common.set);
    status = run_pull(words->request);
  });
}

}  // namespace windlass::app
