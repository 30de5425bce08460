#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

void add_locus(CLI::App& app, CommonOptions& common, int& status) {
  CLI::App* command = app.add_subcommand("locus", "the curve of a special point in two parameters");
  command->footer(
      "The first parameter is the run's continuation.parameter; the second is --in. Example:\n"
      "  windlass locus runs/capstan-2pi F1 --in load.angle --to 6.6");
  const auto request = std::make_shared<LocusRequest>();
  command->add_option("RUN", request->run, "run folder")->required()->type_name("");
  command->add_option("LABEL", request->label, "a special point of the run, e.g. B1")
      ->required()
      ->type_name("");
  command->add_option("--in", request->second, "the second parameter, a numeric scene key")
      ->type_name("KEY")
      ->capture_default_str();
  command->add_option("--from", request->from, "its smallest value, dimensionless");
  command->add_option("--to", request->to, "its largest value, dimensionless");
  add_common_options(*command, common);
  command->callback([request, &common, &status] {
    request->common = common;
    request->scene = scene_of_run(request->run, common);
    if (!scene::is_numeric_key(request->second))
      throw InputError("--in " + request->second + ": must be a numeric scene key; did you mean " +
                       std::string(scene::nearest_key(request->second)) + "?");
    status = run_locus(*request);
  });
}

}  // namespace windlass::app
