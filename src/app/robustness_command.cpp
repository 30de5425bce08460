#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_robustness(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand(
      "robustness", "a map of where a start from nothing succeeds, and why it fails elsewhere");
  command->footer(
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
  command->add_option("SCENE", *scene, "scene file (TOML)")->required()->type_name("");
  command->add_option("--tensions", request->grid.tensions, "number of tensions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--angles", request->grid.angles, "number of angles")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  const robustness::Grid whole;
  const auto tensions =
      std::make_shared<std::vector<double>>(std::vector{whole.tension_low, whole.tension_high});
  const auto angles = std::make_shared<std::vector<double>>(std::vector{whole.angle_low, whole.angle_high});
  command->add_option("--tension-range", *tensions, "[EI/rho^2]")
      ->expected(2)
      ->check(CLI::PositiveNumber)
      ->type_name("LOW HIGH")
      ->capture_default_str();
  command->add_option("--angle-range", *angles, "[rad]")
      ->expected(2)
      ->check(CLI::PositiveNumber)
      ->type_name("LOW HIGH")
      ->capture_default_str();
  command->add_flag("--grid-only", request->grid_only, "leave the hard places out");
  add_common_options(*command, common);
  command->callback([request, scene, tensions, angles, &common, &status] {
    request->common = common;
    robustness::Grid& grid = request->grid;
    grid.tension_low = tensions->front(), grid.tension_high = tensions->back();
    grid.angle_low = angles->front(), grid.angle_high = angles->back();
    request->scene = scene::read_scene(*scene, common.set);
    status = run_robustness(*request);
  });
}

}  // namespace windlass::app
