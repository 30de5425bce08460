#include "app/branch_run.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "app/branch_recorder.hpp"
#include "app/branch_setup.hpp"
#include "app/interrupt.hpp"
#include "windlass/equilibrium/codec.hpp"
#include "windlass/output/error.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace fs = std::filesystem;

namespace {

output::WriterOptions writer_options(const BranchRequest& request, const std::string& command,
                                     const std::string& key) {
  output::WriterOptions options;
  options.force = request.common.force;
  options.command = command;
  options.version = WINDLASS_VERSION;
  options.save_every = request.save_every;
  options.parameter = key;
  if (key != "load.tension" && key != "load.angle" && key != "ends.shortening") options.extra_parameter = key;
  // With the scene, all that decides what the run will hold.
  options.options["from"] = nullptr;
  if (request.run)
    options.options["from"] = {{"run", fs::weakly_canonical(*request.run).string()},
                               {"label", request.label}};
  options.options["eigenvalues"] = request.eigenvalues;
  options.options["petsc"] = request.common.petsc;
  return options;
}

/// The first line in which two scenes differ, to tell the user; empty if they are equal.
std::string difference(const std::string& stored, const std::string& asked) {
  std::istringstream left(stored), right(asked);
  std::string a, b;
  for (bool more = true; more;) {
    const bool in_left = static_cast<bool>(std::getline(left, a));
    const bool in_right = static_cast<bool>(std::getline(right, b));
    more = in_left && in_right;
    if (in_left != in_right || (more && a != b))
      return "it has \"" + (in_left ? a : "") + "\" where this one has \"" + (in_right ? b : "") + "\"";
  }
  return {};
}

/// @throws InputError when the stored run is not the one that is asked for
void require_same(const output::Run& run, const BranchRequest& request,
                  const output::WriterOptions& options) {
  const auto refuse = [&](const std::string& why) {
    throw InputError("--resume: " + run.folder.string() + " holds another run: " + why +
                     "; use --force to replace it or --out to write elsewhere");
  };
  if (run.info.command != options.command)
    refuse("it was made by `" + run.info.command + "`, not by `" + options.command + "`");
  if (run.info.version != options.version)
    refuse("it was made by version " + run.info.version + ", this is " + options.version);
  if (const std::string found = difference(run.scene_toml, request.scene.resolved_toml); !found.empty())
    refuse("in the scene " + found);
  if (run.info.options != options.options)
    refuse("it has the options " + run.info.options.dump() + " where this one has " + options.options.dump());
}

/// What --resume finds in a folder.
struct Found {
  bool started = false;                          ///< a run of ours, so nothing foreign would be overwritten
  std::optional<output::RunInfo> over;           ///< the run has come to its end
  std::optional<output::Checkpoint> checkpoint;  ///< it goes on from here
};

Found look_for_run(const fs::path& folder, const BranchRequest& request,
                   const output::WriterOptions& options) {
  Found found;
  if (!fs::is_regular_file(folder / "run.json")) {
    found.started = fs::is_regular_file(folder / "scene.toml");  // killed while it was being set up
    return found;
  }
  const output::Run run = output::read_run(folder, false);
  require_same(run, request, options);
  found.started = true;
  if (run.info.status == "finished" || run.info.status == "incomplete")
    found.over = run.info;
  else
    found.checkpoint = output::read_checkpoint(folder);
  return found;
}

int nothing_to_do(const output::RunInfo& info, const fs::path& folder, const CommonOptions& common) {
  if (common.json) std::printf("%s\n", output::to_json(info).dump(2).c_str());
  if (!common.quiet && !common.json)
    std::printf("%s is %s: nothing to resume\n", folder.string().c_str(), info.status.c_str());
  return info.status == "finished" ? done : not_finished;
}

continuation::DiagramState restored(const output::Checkpoint& checkpoint, const fs::path& folder,
                                    const BranchSetup& setup, const continuation::ProblemCodec& codec) {
  try {
    return continuation::decode(checkpoint.state, setup.options, codec);
  } catch (const std::runtime_error& error) {  // damaged
    throw output::OutputError("cannot go on with " + folder.string() + ": " + error.what());
  }
}

}  // namespace

int run_branches(const BranchRequest& request, const std::string& command,
                 const continuation::DiagramOptions& limits) {
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  const BranchSetup setup = set_up_branch(request);
  const fs::path folder = output_folder(request.common, request.scene);
  output::WriterOptions options = writer_options(request, command, setup.key);
  Found found;
  if (request.resume) found = look_for_run(folder, request, options);
  if (found.over) return nothing_to_do(*found.over, folder, request.common);
  options.force = options.force || found.started;
  const continuation::ProblemCodec codec = equilibrium::rod_codec(setup.scene, {setup.key});
  const auto record = [&](output::RunWriter writer, const auto& walk) {
    BranchRecorder recorder(writer, codec, setup.scene, request.eigenvalues, request.common.quiet);
    recorder.start_clock();
    const continuation::Diagram diagram = walk(recorder);
    return recorder.finish(diagram, request.common.quiet, request.common.json);
  };
  if (found.checkpoint) {
    continuation::DiagramState state = restored(*found.checkpoint, folder, setup, codec);
    return record(output::RunWriter::resume(folder, found.checkpoint->extent, request.save_every),
                  [&](BranchRecorder& recorder) {
                    return resume_diagram(std::move(state), setup.options, limits, recorder);
                  });
  }
  const FirstState first = first_state(setup);  // before the folder is made
  const equilibrium::Started& start = first.state;
  continuation::DiagramOptions way = limits;
  way.from_behind = first.inside;
  return record(output::RunWriter::create(folder, request.scene, options), [&](BranchRecorder& recorder) {
    return trace_diagram(start.problem, start.x, start.p, setup.options, way, recorder);
  });
}

}  // namespace windlass::app
