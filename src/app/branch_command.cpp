#include <memory>

#include "app/commands.hpp"
#include "app/stored_point.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

namespace {

/// `continue` and `diagram` take the same words: a scene file, or a run folder and the label of a stored point.
void add_branch_command(Command& command, CommonOptions& common, int& status,
                        int (*run)(const BranchRequest&)) {
  struct Words {
    std::string start, label;
    bool resume = false, eigenvalues = true;
    std::optional<double> save_every;
  };
  const auto words = std::make_shared<Words>();
  command.add("SCENE", words->start, "scene file (TOML), or a run folder to restart from")
      .required()
      .type("");
  command.add("LABEL", words->label, "with a run folder: the stored point, e.g. B1").type("");
  add_common_options(command, common);
  const Option resume = command.add_flag("--resume", words->resume, "go on with the run in the folder --out");
  command.option("--force").excludes(resume);
  command
      .add("--save-every", words->save_every,
           "seconds between two savings of what --resume needs; 0: at every point (default 1, more "
           "where saving takes long)")
      .between(0.0, 1e6)
      .type("SECONDS");
  command.add_flag("!--no-eigenvalues", words->eigenvalues,
                   "the lowest eigenvalue at special points only; every point keeps its index");
  command.run([words, run, &common, &status] {
    BranchRequest request{common,           {}, std::nullopt, words->label, words->resume, words->eigenvalues,
                          words->save_every};
    if (std::filesystem::is_directory(words->start)) {
      request.run = words->start;
      request.scene = scene_of_run(words->start, common, true);
      if (words->label.empty())
        throw InputError(words->start +
                         ": is a run folder; say which stored point to restart from (a label)");
      if (const auto own = setting_of_point(output::read_run(words->start), words->label)) {
        CommonOptions there = common;
        there.set.push_back(*own);  // the scene that is written is that of the point
        request.scene = scene_of_run(words->start, there, true);
      }
    } else {
      request.scene = scene::read_scene(words->start, common.set);
      if (!words->label.empty())
        throw InputError("label \"" + words->label + "\": needs a run folder, not a scene file");
    }
    if (!request.scene.continuation)
      throw scene::SceneError(words->start + ": [continuation]: missing; this command needs continuation.to");
    status = run(request);
  });
}

}  // namespace

void add_continue(CommandLine& app, CommonOptions& common, int& status) {
  Command command =
      app.add_command("continue", "one branch in T or phi (or any numeric scene key) from the scene's start");
  command.footer(
      "The branch and its special points go to the run folder, a row per point. Any stored point restarts a "
      "run:\n"
      "  windlass continue RUN LABEL --set continuation.to=0.1 --out DIR");
  add_branch_command(command, common, status, run_continue);
}

void add_diagram(CommandLine& app, CommonOptions& common, int& status) {
  Command command =
      app.add_command("diagram", "the branch, its special points, and every branch that leaves them");
  command.footer("Exit status 2 if a branch was lost; the diagram then says where.");
  add_branch_command(command, common, status, run_diagram);
}

}  // namespace windlass::app
