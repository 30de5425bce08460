#include "sliding_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::figures {

std::string on_plate_run(const Angle& angle) { return std::string("plate-") + angle.run; }
std::string in_space_run(const Angle& angle) { return on_plate_run(angle) + "-space"; }

std::vector<PlannedRun> sliding_runs() {
  constexpr const char* scene = "capstan-2pi-plate";
  constexpr const char* values[] = {"4 pi", "2 pi", "pi", "pi/2", "pi/4"};
  static_assert(std::size(values) == std::size(angles));
  std::vector<PlannedRun> runs;
  for (std::size_t k = 0; k < std::size(angles); ++k) {
    // At T = 1/2 tails of 28 ρ are as good as infinite ones: exp(-2 √T 28) is below rounding.
    const std::vector<std::string> common{std::string("load.angle=") + values[k], "rod.length=70",
                                          "continuation.from=10"};
    std::vector<std::string> flat = common, space = common;
    flat.insert(flat.end(), {"model.kind=planar", "continuation.to=0.3", "continuation.step_max=0.03"});
    space.insert(space.end(),
                 {"continuation.to=0.501",
                  "continuation.step_max=0.1"});  // the chain in space has no step from a line to touches
    runs.push_back({on_plate_run(angles[k]), scene, flat, false});
    runs.push_back({in_space_run(angles[k]), scene, space, false});
  }
  runs.push_back(
      {dragged_run,
       scene,
       {"model.kind=kirchhoff", "continuation.from=0.3", "continuation.to=10", "continuation.step_max=0.03"},
       false,
       true});
  return runs;
}

double strength_of(const output::BranchRow& row, const StudyRun& study) {
  return row.F0.value() / study.scene.friction.value();
}

void write_strengths(const std::string& run, const StudyRun& study, const Canvas& canvas) {
  std::array<std::string, 2> blocks;
  const auto& rows = study.run.rows;
  const auto line = [&](const output::BranchRow& row) {
    return output::data_line({row.T, strength_of(row, study)});
  };
  std::size_t drawn = blocks.size();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::size_t now = output::index_between(rows[i - 1], rows[i]) == 0 ? 0 : 1;
    if (now != drawn) blocks[now] += "\n" + line(rows[i - 1]);
    blocks[now] += line(rows[i]);
    drawn = now;
  }
  std::string text = "# T | F0/μ; ? = not defined\n";
  for (std::size_t k = 0; k < blocks.size(); ++k)
    text += fmt::format("# block {}: {}\n? ?\n{}\n\n", k, k == 0 ? "stable" : "unstable", blocks[k]);
  output::replace_file(canvas.folder / ("sliding-" + run + ".dat"), std::string_view(text));
}

namespace {

/// From rest to the plateau, or to where the rod can no longer be followed.
void pull_on(pull::Pull& rod, PullCurve& curve, const pull::Options& options) {
  while (!curve.at && rod.state().displacement < pull::usual_reach) {
    const auto row = rod.advance();
    if (!row || row->at.R_tot == 0.0) return;
    curve.rows.push_back(*row);
    curve.at = pull::plateau(curve.rows, options);
  }
}

scene::Scene at_tension(const StudyRun& study, double tension) {
  scene::Scene scene = study.scene;
  scene.load.tension = tension;
  scene.model.kind = scene::ModelKind::automatic;
  scene.continuation.reset();
  return scene;
}

}  // namespace

std::vector<PullCurve> pull_curves(const Study& study) {
  const StudyRun &dragged = study.at(dragged_run), &flat = study.at(on_plate_run(pulled));
  std::vector<PullCurve> curves;
  for (const double tension : {0.4, 0.57, 1.0, 2.0}) {
    const scene::Scene scene = at_tension(dragged, tension);
    const auto stretches = output::stable_stretches(dragged.run);
    const bool off = std::ranges::any_of(stretches, [&](const output::StableStretch& stretch) {
      return stretch.lowest <= tension && tension <= stretch.highest;
    });
    PullCurve curve{tension, off, (off ? dragged : flat).stable_force(tension), {}, {}};
    constexpr double coarse = 0.14;  // [ρ], as `windlass pull`
    const pull::Options options;
    pull::Pull rod(pull::setting_of(scene), 0.5 * scene.rod.length, pull::mesh_under(tension, coarse),
                   options);
    if (rod.start(equilibrium::solve(pull::at_rest(scene)))) pull_on(rod, curve, options);
    curves.push_back(std::move(curve));
  }
  return curves;
}

void write_pulls(const std::vector<PullCurve>& curves, double friction, const Canvas& canvas) {
  std::string text = "# U | F/μ; a block a tension\n";
  for (const PullCurve& curve : curves) {
    text += fmt::format("# T = {}\n? ?\n", curve.tension);
    for (const pull::Row& row : curve.rows)
      text += output::data_line({row.displacement, row.at.drag / friction});
    text += "\n\n";
  }
  output::replace_file(canvas.folder / pull_file, std::string_view(text));
}

std::vector<Search> searches(const Study& study) {
  std::vector<Search> list;
  for (const Angle& angle : angles)
    for (const double tension : {0.3, 0.4, 1.0}) {
      scene::Scene scene = at_tension(study.at(dragged_run), tension);
      scene.load.angle = study.at(on_plate_run(angle)).phi();
      const equilibrium::Equilibria found = equilibrium::equilibria(scene);
      constexpr double flat = 1e-7;  // [ρ] of height
      list.push_back({angle, tension, found.states.size() - (found.answer.z_span < flat ? 1 : 0)});
    }
  return list;
}

}  // namespace windlass::figures
