#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/robustness/cold_start.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace {

using robustness::Answer;
using robustness::Case;
using robustness::Outcome;

std::string row(const Case& one, const Answer& answer) {
  return fmt::format("{},{:.17g},{:.17g},{:.17g},{},{},{},{},{:.17g},{},{:.3g},{}\n",
                     output::csv_cell(one.place), one.scene.load.tension, one.scene.load.angle,
                     one.scene.rod.length,
                     one.scene.ends.kind == scene::EndKind::clamped ? "clamped" : "moment_free",
                     one.scene.model.symmetry == scene::Symmetry::none ? "none" : "half_turn",
                     robustness::name(answer.outcome), answer.topology, answer.R_tot,
                     answer.newton_iterations, answer.seconds, output::csv_cell(answer.cause));
}

/// The grid as squares: grey where no equilibrium exists, the number of Newton steps in colour where one was found,
/// crosses where the start failed.
void draw(const std::vector<std::pair<Case, Answer>>& grid, const std::filesystem::path& folder) {
  std::string solved, impossible, failed;
  for (const auto& [one, answer] : grid) {
    std::string& data = answer.outcome == Outcome::solved       ? solved
                        : answer.outcome == Outcome::impossible ? impossible
                                                                : failed;
    data += fmt::format("{:.9g} {:.9g} {}\n", one.scene.load.angle / M_PI, one.scene.load.tension,
                        answer.newton_iterations);
  }
  const auto written = [&](const std::string& name, const std::string& data) {
    output::replace_file(folder / name, std::string_view(data.empty() ? "NaN NaN NaN\n" : data));
  };
  written("robustness-solved.dat", solved);
  written("robustness-impossible.dat", impossible);
  written("robustness-failed.dat", failed);
  output::Picture picture{"robustness", 6.0, 4.6, ""};
  picture.body =
      "set logscale y\nset format y '10^{%L}'\nset xlabel 'capstan angle {/Symbol f}/{/Symbol p}'\n"
      "set ylabel 'tension T'\nset logscale cb\nset cblabel 'Newton steps'\nset palette defined (0 "
      "'#440154', 1 '#31688e', 2 '#35b779', 3 '#fde725')\n"
      "set key outside top center horizontal\nset offsets graph 0.02, graph 0.02, 0, 0\n"
      "plot 'robustness-solved.dat' using 1:2:3 with points pt 5 ps 0.55 lc palette title 'solved', \\\n"
      "     'robustness-impossible.dat' using 1:2 with points pt 4 ps 0.45 lc rgb '#999999' title 'no "
      "equilibrium', \\\n"
      "     'robustness-failed.dat' using 1:2 with points pt 2 ps 0.7 lc rgb '#d62728' title 'failed'\n";
  output::run_gnuplot(picture, folder, {"png", "svg", "pdf"});
}

}  // namespace

int run_robustness(const RobustnessRequest& request) {
  if (!request.scene.has_cylinder)
    throw InputError(request.scene.name + ": robustness needs a scene with a [cylinder]");
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  std::vector<Case> cases;
  if (!request.grid_only) cases = robustness::hard_cases(request.scene);
  const std::size_t hard = cases.size();
  const std::vector<Case> squares = robustness::grid_cases(request.scene, request.grid);
  cases.insert(cases.end(), squares.begin(), squares.end());

  const std::filesystem::path folder = output_folder(request.common, request.scene);
  const std::filesystem::path table = folder / "robustness.csv";
  if (std::filesystem::exists(table) && !request.common.force)
    throw InputError(table.string() + ": exists; --force replaces it, --out names another folder");
  std::filesystem::create_directories(folder);
  output::replace_file(table,
                       std::string_view("place,T,phi,length,ends,symmetry,outcome,topology,R_tot,newton_"
                                        "iterations,seconds,cause\n"));
  output::AppendFile rows(table);
  std::vector<std::pair<Case, Answer>> answers;
  std::map<std::string, int> counts;
  Progress progress(request.common.quiet || request.common.json);
  for (const Case& one : cases) {
    if (interrupted_by_user()) break;
    const Answer answer = robustness::try_case(one);
    rows.append(row(one, answer));
    answers.emplace_back(one, answer);
    ++counts[std::string(robustness::name(answer.outcome))];
    if (answer.outcome != Outcome::solved && answer.outcome != Outcome::impossible)
      progress.note(fmt::format("{}: T = {:.6g}, phi = {:.6g}: {}", robustness::name(answer.outcome),
                                one.scene.load.tension, one.scene.load.angle, answer.cause));
    if (progress.due()) progress.update(fmt::format("case {} of {}", answers.size(), cases.size()));
  }
  progress.finish();
  if (answers.size() > hard)
    draw({answers.begin() + static_cast<std::ptrdiff_t>(hard), answers.end()}, folder);

  const int solved = counts["solved"], impossible = counts["impossible"];
  const int failed = static_cast<int>(answers.size()) - solved - impossible;
  if (request.common.json) {
    nlohmann::ordered_json out{{"cases", answers.size()}, {"failed", failed}};
    for (const auto& outcome : robustness::outcome_names)
      out["outcomes"][std::string(outcome)] = counts[std::string(outcome)];
    std::printf("%s\n", out.dump(2).c_str());
  } else if (!request.common.quiet) {
    std::printf("%zu cases: %d solved, %d without an equilibrium, %d failed -> %s\n", answers.size(), solved,
                impossible, failed, folder.string().c_str());
  }
  if (answers.size() < cases.size()) return interrupted;
  return failed > 0 ? not_finished : done;
}

}  // namespace windlass::app
