#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

void add_sweep(CommandLine& app, CommonOptions& common, int& status) {
  Command command =
      app.add_command("sweep", "states or branches over a grid of scene keys, spread over MPI ranks");
  command.footer(
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
  command.add("SCENE", request->scene, "scene file (TOML)").required().type("");
  command.add("--over", request->over, "values of a scene key (repeatable)")
      .required()
      .type("KEY=FROM:TO:COUNT[:log] or KEY=A,B,...")

      .repeatable();
  command.add("--each", request->each, "what is done with a case")
      .one_of({"solve", "continue", "diagram"})
      .default_shown();
  add_common_options(command, common);
  const Option resume =
      command.add_flag("--resume", request->resume, "go on with the sweep in the folder --out");
  command.option("--force").excludes(resume);
  command.run([request, &common, &status] {
    request->common = common;
    status = run_sweep(*request);
  });
}

}  // namespace windlass::app
