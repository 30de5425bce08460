#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

void add_sweep(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command =
      app.add_subcommand("sweep", "states or branches over a grid of scene keys, spread over MPI ranks");
  command->footer(
      "  windlass sweep SCENE --over 'load.angle=1 pi:4 pi:7' --over load.tension=0.6:100:12:log\n"
      "  mpirun -n 2 windlass sweep SCENE --over ...      the same tables, bit for bit\n"
      "  windlass sweep SCENE --each diagram --over 'load.angle=1.5 pi,2 pi,3 pi'\n"
      "A case is the scene with its values set; each starts from nothing, so that none depends on another. "
      "DIR/sweep.csv has a\n"
      "row a case; with --each continue or diagram DIR/branches.csv has every point of every branch, and "
      "DIR/cases/NNNNNN is the\n"
      "run. --resume goes on with a sweep that was stopped or killed. Exit status 2 if a case failed; its "
      "row "
      "says why.\nDIR is runs/SCENE-NAME-sweep unless --out says otherwise.");
  const auto request = std::make_shared<SweepRequest>();
  command->add_option("SCENE", request->scene, "scene file (TOML)")->required()->type_name("");
  command->add_option("--over", request->over, "values of a scene key (repeatable)")
      ->required()
      ->type_name("KEY=FROM:TO:COUNT[:log] or KEY=A,B,...")
      ->take_all()
      ->expected(1);
  command->add_option("--each", request->each, "what is done with a case")
      ->check(CLI::IsMember({"solve", "continue", "diagram"}))
      ->capture_default_str();
  add_common_options(*command, common);
  CLI::Option* resume =
      command->add_flag("--resume", request->resume, "go on with the sweep in the folder --out");
  command->get_option("--force")->excludes(resume);
  command->callback([request, &common, &status] {
    request->common = common;
    status = run_sweep(*request);
  });
}

}  // namespace windlass::app
