#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "windlass/figures/figure.hpp"
#include "windlass/output/error.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

namespace fs = std::filesystem;

namespace {

void prepare_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(folder.string() + ": is not a folder");
  if (fs::exists(folder) && !fs::is_empty(folder) && !force)
    throw InputError("the folder " + folder.string() + " exists and is not empty; use --force");
  fs::create_directories(folder, error);
  if (error) throw output::OutputError("cannot make the folder " + folder.string() + ": " + error.message());
}

/// One run of the study through the command that makes it. @return its exit status
int compute(const figures::PlannedRun& plan, const fs::path& out, const CommonOptions& common,
            figures::Study& study) {
  BranchRequest request;
  request.common = common;
  request.common.set = plan.settings;
  request.common.set.insert(request.common.set.end(), common.set.begin(), common.set.end());
  request.common.out = out / "runs" / plan.name;
  request.common.quiet = true;
  request.common.json = false;
  request.eigenvalues = false;  // the index is enough here
  request.scene = scene::read_scene(scenes_folder() / (plan.scene + ".toml"), request.common.set);
  const int status = plan.diagram ? run_diagram(request) : run_continue(request);
  study[plan.name] = {
      request.scene, output::read_run(request.common.out),
      figures::command_of(plan, fs::proximate(scenes_folder()).string(), request.common.out.string())};
  return status;
}

/// What agrees with the paper and what does not, of each figure.
nlohmann::ordered_json to_json(const std::vector<figures::Statement>& statements) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const figures::Statement& statement : statements)
    list.push_back({{"paper", statement.paper},
                    {"here", statement.here},
                    {"verdict", figures::name(statement.verdict)},
                    {"why", statement.why}});
  return list;
}

}  // namespace

int run_figures(const FiguresRequest& request) {
  const auto begin = std::chrono::steady_clock::now();
  const fs::path out = request.common.out.empty() ? fs::path("figures") : request.common.out;
  prepare_folder(out, request.common.force);
  Progress progress(request.common.quiet);
  figures::Study study;
  bool incomplete = false;
  for (const auto& plan : figures::planned_runs()) {
    progress.update("computing " + plan.name);
    const int status = compute(plan, out, request.common, study);
    if (status == interrupted) return interrupted;
    if (status != done && !plan.may_end)
      incomplete = true, progress.note(plan.name + ": a branch was lost; the page says where");
  }
  progress.update("drawing");
  const figures::Canvas canvas{out, request.formats};
  const auto drawn = figures::draw_all(study, canvas);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto page = figures::write_page(drawn, study, canvas, "windlass figures", seconds);
  progress.finish();
  if (request.common.json) {
    nlohmann::ordered_json json{{"page", page.string()}, {"seconds", seconds}, {"incomplete", incomplete}};
    for (const auto& figure : drawn) {
      json["figures"].push_back(figure.stem);
      json["statements"][figure.stem] = to_json(figure.statements);
    }
    fmt::print("{}\n", json.dump(2));
  } else if (!request.common.quiet) {
    fmt::print("{}  ({} figures, {:.1f} s)\n", page.string(), drawn.size(), seconds);
  }
  return incomplete ? not_finished : done;
}

}  // namespace windlass::app
