#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_robustness(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command(
      "robustness", "a map of where a start from nothing succeeds, and why it fails elsewhere");
  command.footer(
      "Each case (tension evenly in its logarithm, angle evenly, the rod's length ample) is solved from "
      "nothing and its\n"
      "answer put to the certificate of `verify`: in the plane with --set model.kind=planar, in space "
      "otherwise. Before the\n"
      "grid come the hard places: close to the limit of line contact and to phi = pi, extreme tensions, very "
      "long and\n"
      "very short tails, 20 pi of wrap, full chains. DIR/robustness.csv has a row a case, the picture a "
      "square. Exit\n"
      "status 2 if a case failed; one without an equilibrium is no failure.");
  const auto request = std::make_shared<RobustnessRequest>();
  const auto scene = std::make_shared<std::string>();
  command.add("SCENE", *scene, "scene file (TOML)").required().type("");
  command.add("--tensions", request->grid.tensions, "number of tensions").between(1, 1000).default_shown();
  command.add("--angles", request->grid.angles, "number of angles").between(1, 1000).default_shown();
  const robustness::Grid whole;
  const auto tensions =
      std::make_shared<std::vector<double>>(std::vector{whole.tension_low, whole.tension_high});
  const auto angles = std::make_shared<std::vector<double>>(std::vector{whole.angle_low, whole.angle_high});
  command.add("--tension-range", *tensions, "[EI/rho^2]")
      .values(2)
      .positive()
      .type("LOW HIGH")
      .default_shown();
  command.add("--angle-range", *angles, "[rad]").values(2).positive().type("LOW HIGH").default_shown();
  command.add_flag("--grid-only", request->grid_only, "leave the hard places out");
  add_common_options(command, common);
  command.run([request, scene, tensions, angles, &common, &status] {
    request->common = common;
    robustness::Grid& grid = request->grid;
    grid.tension_low = tensions->front(), grid.tension_high = tensions->back();
    grid.angle_low = angles->front(), grid.angle_high = angles->back();
    request->scene = scene::read_scene(*scene, common.set);
    status = run_robustness(*request);
  });
}

}  // namespace windlass::app
