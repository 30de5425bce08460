#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/pull_folder.hpp"
#include "app/pull_report.hpp"
#include "app/stored_point.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::app {

namespace {

using Clock = std::chrono::steady_clock;

/// Coarsest first.
std::vector<double> meshes_of(const PullRequest& request, double tension) {
  std::vector<double> meshes = request.meshes;
  if (meshes.empty())
    for (const double h : {0.14, 0.1, 0.07}) meshes.push_back(pull::mesh_under(tension, h));
  std::ranges::sort(meshes, std::greater());
  for (const double h : meshes)
    if (!(h > 0.0 && h <= 0.25)) throw InputError(fmt::format("--mesh: {:g}: must be in (0, 0.25]", h));
  if (std::ranges::adjacent_find(meshes) != meshes.end())
    throw InputError("--mesh: two meshes are the same; a limit needs different ones");
  return meshes;
}

std::string description(const PullRequest& request, const std::vector<double>& meshes) {
  return nlohmann::ordered_json{{"version", WINDLASS_VERSION},
                                {"scene", request.scene.resolved_toml},
                                {"meshes", meshes},
                                {"to", request.to},
                                {"step", request.step},
                                {"petsc", request.common.petsc}}
      .dump();
}

/// The steady states that `solve` lists.
void find_states(const PullRequest& request, PullResult& result) {
  const Heartbeat heartbeat(request.scene.name + ": searching the steady states", request.common.quiet);
  try {
    result.states = equilibrium::equilibria(request.scene).states;
    add_indices(result.states, equilibrium::determinate(request.scene));
  } catch (const equilibrium::NoEquilibrium& error) {
    result.states.clear();
    result.no_states = error.what();
  }
}

/// All meshes, one after the other; goes on with what a folder holds.
class PullRun {
 public:
  PullRun(const PullRequest& request, std::vector<double> meshes, const PullFolder& folder,
          PullResult& result)
      : request_(request), heights_(std::move(meshes)), folder_(folder), result_(result) {
    options_.step = request.step;
    options_.window = std::max(options_.window, request.step);
  }

  /// @return  false where it was interrupted or failed
  bool run(std::optional<PullFolder::Checkpoint> found) {
    const scene::Scene scene = scene::natural(request_.scene);
    const equilibrium::Solution start = equilibrium::solve(pull::at_rest(scene));
    std::size_t first = 0;
    std::optional<pull::State> state;
    if (found && !found->meshes.empty()) {
      result_.meshes = std::move(found->meshes);
      state = std::move(found->state);
      first = result_.meshes.size() - 1;
      for (std::size_t k = 0; k < first; ++k)
        result_.plateaus.push_back(pull::plateau(result_.meshes[k].rows, options_));
    }
    Progress progress(request_.common.quiet);
    for (std::size_t k = first; k < heights_.size(); ++k) {
      if (k == result_.meshes.size()) result_.meshes.push_back({heights_[k], {}});
      last_ = std::make_unique<pull::Pull>(pull::setting_of(scene), 0.5 * scene.rod.length, heights_[k],
                                           options_);
      pull::Pull& one = *last_;
      if (state)
        one.resume(*std::exchange(state, std::nullopt));
      else if (!one.start(start))
        return fail("the frictionless state could not be relaxed on this mesh");
      if (!pull_one(one, progress)) return false;
    }
    return true;
  }

  /// The pull on the finest mesh.
  const pull::Pull& last() const { return *last_; }

 private:
  bool fail(std::string why) {
    result_.failure = std::move(why);
    result_.plateaus.resize(result_.meshes.size());
    return false;
  }

  bool pull_one(pull::Pull& one, Progress& progress) {
    PulledMesh& mesh = result_.meshes.back();
    auto at = pull::plateau(mesh.rows, options_);
    while (!at && one.state().displacement < request_.to) {
      if (interrupted_by_user()) {
        folder_.save(result_.meshes, &one.state());
        result_.plateaus.resize(result_.meshes.size());
        return false;
      }
      const auto row = one.advance();
      if (!row) {
        folder_.save(result_.meshes, &one.state());
        return fail(fmt::format("h = {:g}: no equilibrium found beyond U = {:.6g}, not even after a jump",
                                mesh.h, one.state().displacement));
      }
      mesh.rows.push_back(*row);
      if (row->at.R_tot == 0.0)
        return fail(fmt::format("h = {:g}: the rod has come off the cylinder at U = {:.6g}", mesh.h,
                                row->displacement));
      at = pull::plateau(mesh.rows, options_);
      if (row->jumped)
        progress.note(fmt::format("h = {:g}: the rod jumps at U = {:.6g}", mesh.h, row->displacement));
      if (progress.due())
        progress.update(fmt::format("mesh {} of {}, h = {:g}: U = {:.3f}, F = {:.6g}, {:.0f} % sticks",
                                    result_.meshes.size(), heights_.size(), mesh.h, row->displacement,
                                    row->at.drag * result_.force, 100.0 * row->at.sticking));
      if (Clock::now() - saved_ > pause) {
        folder_.save(result_.meshes, &one.state());
        saved_ = Clock::now();
      }
    }
    result_.plateaus.push_back(at);
    return true;
  }

  static constexpr std::chrono::milliseconds pause{250};  // between two checkpoints

  const PullRequest& request_;
  std::vector<double> heights_;
  const PullFolder& folder_;
  PullResult& result_;
  pull::Options options_;
  std::unique_ptr<pull::Pull> last_;
  Clock::time_point saved_ = Clock::now();
};

/// Among the states of `solve`; where it is none of them, the plateau's own on exact arcs joins them if there is one.
void select(const PullRequest& request, const pull::Pull& finest, PullResult& result) {
  result.selection = pull::selected(result.limit->at, result.states, result.force);
  if ((result.selection && result.selection->state) || !result.limit->one_state()) return;
  const auto own =
      pull::polished(finest, result.limit->at, scene::natural(request.scene), result.not_polished);
  if (!own) return;
  result.states.push_back(*own);
  add_indices(std::span(result.states).last(1), equilibrium::determinate(request.scene));
  result.own = true;
  result.selection = pull::selected(result.limit->at, result.states, result.force);
}

std::vector<std::filesystem::path> draw(const PullRequest& request, const PullResult& result,
                                        const std::filesystem::path& folder) {
  pull::PictureRequest picture;
  picture.meshes = result.outcomes();
  if (result.limit) picture.limit = result.limit->at.drag;
  for (const equilibrium::StateSummary& state : result.states)
    picture.steady.push_back(*state.F0 / result.force);
  if (result.selection) picture.selected = result.selection->state;
  picture.force = result.force;
  if (request.scene.units) picture.newtons = request.scene.units->force;
  picture.title =
      fmt::format("{}: T = {:.4g}, φ = {:.4g}, μ = {:.4g}", request.scene.name, request.scene.load.tension,
                  request.scene.load.angle, request.scene.friction.value_or(0.0));
  picture.formats = request.formats;
  return pull::draw(picture, folder);
}

int nothing_to_do(const PullFolder& folder, const CommonOptions& common) {
  if (common.json) std::printf("%s\n", folder.outcome().dump(2).c_str());
  if (!common.json && !common.quiet) std::printf("%s is over: nothing to resume\n", folder.path().c_str());
  return done;
}

}  // namespace

int run_pull(const PullRequest& request) {
  const scene::Scene& scene = request.scene;
  if (!scene.slides())
    throw scene::SceneError(scene.name +
                            ": cylinder.sliding: missing; a pull needs \"up\", a friction and a plate");
  if (scene.ends.left_kind() != scene::EndKind::moment_free ||
      scene.ends.right_kind() != scene::EndKind::moment_free)
    throw scene::SceneError(scene.name +
                            ": ends.kind: a pull needs \"moment_free\": the discrete rod's ends turn");
  if (scene.friction_arm() > 0.0)
    throw scene::SceneError(
        scene.name + ": cylinder.friction_couple: a pull needs false: its friction acts at the centre line");
  if (scene.ends.guided())
    throw scene::SceneError(
        scene.name + ": ends.guide: a pull needs \"none\": the discrete rod's ends are under dead pulls");
  if (scene.plate && !std::isinf(scene.plate->outer_radius))
    throw scene::SceneError(scene.name +
                            ": plate.outer_radius: a pull needs \"inf\": its plate has no outer edge");
  const std::vector<double> meshes = meshes_of(request, scene::natural(scene).load.tension);
  petsc::ensure_session();
  PullResult result;
  result.force = scene::natural(scene).solved_in.force;
  const std::filesystem::path path =
      request.common.out.empty() ? output_folder(request.common, scene) += "-pull" : request.common.out;
  PullFolder folder(path, description(request, meshes), result.force);
  const PullFolder::Found found = folder.prepare(scene.resolved_toml, request.common.force, request.resume);
  if (found == PullFolder::Found::over) return nothing_to_do(folder, request.common);
  std::optional<PullFolder::Checkpoint> checkpoint;
  if (found == PullFolder::Found::begun) checkpoint = folder.read();
  find_states(request, result);
  const DeferredInterrupts deferred;
  PullRun run(request, meshes, folder, result);
  const bool complete = run.run(std::move(checkpoint));
  if (!complete && result.failure.empty()) return interrupted;
  if (complete) result.limit = pull::limit_of(result.outcomes());
  if (result.limit) select(request, run.last(), result);
  const nlohmann::ordered_json json = to_json(result, scene);
  if (complete) folder.finish(result.meshes, json);
  if (request.common.json)
    std::printf("%s\n", json.dump(2).c_str());
  else if (!request.common.quiet)
    print(result, scene);
  std::fflush(stdout);
  if (!result.failure.empty()) fmt::print(stderr, "windlass: {}\n", result.failure);
  if (result.meshes.front().rows.empty()) return not_finished;  // nothing to draw
  const auto pictures = draw(request, result, folder.path());
  if (!request.common.json && !request.common.quiet)
    for (const auto& picture : pictures) fmt::print("{}\n", picture.string());
  return complete ? done : not_finished;
}

}  // namespace windlass::app
