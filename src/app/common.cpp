
#include "app/commands.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

void add_common_options(Command& command, CommonOptions& common) {
  command.add("--set", common.set, "set a scene key, e.g. --set load.tension=2 (repeatable)")
      .type("KEY=VALUE")

      .repeatable()
      .group(common_options_group);
  command.add("--out", common.out, "folder for the results (default runs/SCENE-NAME)")
      .type("DIR")
      .group(common_options_group);
  command.add_flag("--force", common.force, "replace what is in that folder").group(common_options_group);
  command.add_flag("--json", common.json, "print the summary as one JSON object on stdout")
      .group(common_options_group);
  command.add_flag("--quiet", common.quiet, "no progress on stderr, no summary text")
      .group(common_options_group);
}

void add_format_option(Command& command, std::vector<std::string>& formats) {
  command.add("--format", formats, "png, svg, pdf (repeatable); png@80 has 80 dots an inch, not 150")
      .checked([](const std::string& word) {
        const bool sized = word.starts_with("png@") && word.size() > 4 &&
                           word.find_first_not_of("0123456789", 4) == std::string::npos;
        const bool known = sized || word == "png" || word == "svg" || word == "pdf";
        return known ? "" : word + ": must be one of png, png@DOTS, svg, pdf";
      })
      .type("TEXT:{png,svg,pdf}")

      .repeatable()
      .default_shown();
}

std::filesystem::path output_folder(const CommonOptions& common, const scene::Scene& scene) {
  return common.out.empty() ? std::filesystem::path("runs") / scene.name : common.out;
}

scene::Scene scene_of_run(const std::filesystem::path& run, const CommonOptions& common, bool restart) {
  if (!std::filesystem::exists(run)) throw InputError(run.string() + ": no such run folder");
  if (!std::filesystem::is_regular_file(run / "scene.toml"))
    throw InputError(run.string() + ": is not a run folder: it has no scene.toml");
  return scene::read_scene(run / "scene.toml", common.set, {restart});
}

}  // namespace windlass::app
