#include <memory>

#include "app/commands.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

void add_locus(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("locus", "the curve of a special point in two parameters");
  command.footer(
      "The first parameter is the run's continuation.parameter; the second is --in. Example:\n"
      "  windlass locus runs/capstan-2pi F1 --in load.angle --to 6.6");
  const auto request = std::make_shared<LocusRequest>();
  command.add("RUN", request->run, "run folder").required().type("");
  command.add("LABEL", request->label, "a special point of the run, e.g. B1").required().type("");
  command.add("--in", request->second, "the second parameter, a numeric scene key")
      .type("KEY")
      .default_shown();
  command.add("--from", request->from, "its smallest value, dimensionless");
  command.add("--to", request->to, "its largest value, dimensionless");
  add_common_options(command, common);
  command.run([request, &common, &status] {
    request->common = common;
    request->scene = scene_of_run(request->run, common);
    if (!scene::is_numeric_key(request->second))
      throw InputError("--in " + request->second + ": must be a numeric scene key; did you mean " +
                       std::string(scene::nearest_key(request->second)) + "?");
    status = run_locus(*request);
  });
}

}  // namespace windlass::app
