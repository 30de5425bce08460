#include <fmt/format.h>
#include <petscsys.h>  // and with it MPI, without its C++ bindings

#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/sweep_case.hpp"
#include "app/sweep_folder.hpp"
#include "app/sweep_grid.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

namespace {

/// Progress of all ranks, as the first one sees it on disk.
class SweepProgress {
 public:
  SweepProgress(const SweepFolder& folder, int cases, bool quiet)
      : folder_(folder), cases_(cases), before_(folder.count()), progress_(quiet) {}
  void update() {
    if (!progress_.due()) return;
    const int finished = folder_.count(), fresh = finished - before_;
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    progress_.update(fmt::format("{} of {} cases, {}", finished, cases_,
                                 fresh > 0 ? left(elapsed * (cases_ - finished) / fresh) : "none timed yet"));
  }

 private:
  using Clock = std::chrono::steady_clock;

  static std::string left(double seconds) {
    if (seconds < 100.0) return fmt::format("about {:.0f} s left", seconds);
    if (seconds < 6000.0) return fmt::format("about {:.0f} min left", seconds / 60.0);
    return fmt::format("about {:.1f} h left", seconds / 3600.0);
  }

  const SweepFolder& folder_;
  int cases_, before_;
  Progress progress_;
  Clock::time_point begin_ = Clock::now();
};

struct Ranks {
  int rank = 0, count = 1;
  Ranks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
  }
  bool first() const { return rank == 0; }
  bool any(bool mine) const {
    int value = mine;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return value != 0;
  }
  /// Waits until all ranks are here.
  void meet(std::optional<SweepProgress>& progress) const {
    MPI_Request request;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    for (int over = 0;;) {
      MPI_Test(&request, &over, MPI_STATUS_IGNORE);
      if (over) return;
      if (progress) progress->update();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
};

/// Runs `body` on the first rank. @return nothing if it went well; otherwise the first rank rethrows and the others
/// have this exit status.
template <class Body>
std::optional<int> on_first(const Ranks& ranks, Body&& body) {
  std::exception_ptr error;
  try {
    if (ranks.first()) body();
  } catch (...) {
    error = std::current_exception();
  }
  const bool failed = ranks.any(error != nullptr);
  if (error) std::rethrow_exception(error);
  return failed ? std::optional<int>(bad_input) : std::nullopt;
}

/// All that decides what a sweep will hold.
std::string description(const SweepRequest& request, const SweepGrid& grid, const scene::Scene& scene) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const SweepAxis& axis : grid.axes()) axes.push_back({{"key", axis.key}, {"values", axis.values}});
  return nlohmann::ordered_json{{"version", WINDLASS_VERSION},
                                {"each", request.each},
                                {"scene", scene.resolved_toml},
                                {"axes", axes},
                                {"petsc", request.common.petsc}}
             .dump(2) +
         "\n";
}

/// The scene of a case; `number` of the first or last case stands for all, to refuse what cannot be before any work.
scene::Scene scene_of(const SweepRequest& request, const SweepGrid& grid, int number) {
  std::vector<std::string> settings = request.common.set;
  for (const std::string& word : grid.settings(number)) settings.push_back(word);
  return scene::read_scene(request.scene, settings);
}

void summarise(const SweepFolder& folder, const SweepRequest& request, int cases, int failed) {
  const int computed = folder.count();
  const std::string table = (folder.path() / "sweep.csv").string();
  if (request.common.json)
    std::printf(
        "%s\n",
        nlohmann::ordered_json{{"cases", cases}, {"computed", computed}, {"failed", failed}, {"table", table}}
            .dump(2)
            .c_str());
  else if (!request.common.quiet)
    std::printf("%d of %d cases, %d of them failed -> %s\n", computed, cases, failed, table.c_str());
}

}  // namespace

int run_sweep(const SweepRequest& request) {
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  const Ranks ranks;
  std::optional<SweepGrid> grid;
  std::optional<SweepFolder> folder;
  bool has_cylinder = true;
  const auto read = [&] {
    std::vector<SweepAxis> axes;
    for (const std::string& text : request.over) axes.push_back(parse_axis(text));
    grid.emplace(std::move(axes));
    scene_of(request, *grid, grid->size() - 1);
    const scene::Scene scene = scene_of(request, *grid, 0);
    has_cylinder = scene.has_cylinder;
    folder.emplace(
        request.common.out.empty() ? output_folder(request.common, scene) += "-sweep" : request.common.out,
        *grid);
    if (ranks.first())
      folder->prepare(description(request, *grid, scene), request.common.force, request.resume);
  };
  if (const auto status = on_first(ranks, read)) return *status;
  if (!ranks.first()) read();

  const SweepCase one(request, *grid, has_cylinder);
  std::optional<SweepProgress> progress;
  if (ranks.first()) progress.emplace(*folder, grid->size(), request.common.quiet);
  std::exception_ptr error;
  try {
    for (int k = ranks.rank; k < grid->size() && !interrupted_by_user(); k += ranks.count) {
      if (folder->has(k)) continue;
      if (const auto row = one.run(k, folder->run_folder(k)))
        output::replace_file(folder->row_file(k), std::string_view(*row));
      if (progress) progress->update();
    }
  } catch (...) {  // the others finish what they can
    error = std::current_exception();
  }
  ranks.meet(progress);
  progress.reset();
  const bool stopped = ranks.any(interrupted_by_user()), broken = ranks.any(error != nullptr);
  if (error) std::rethrow_exception(error);
  int failed = 0;
  const auto gather = [&] {
    failed = folder->merge(one.header());
    summarise(*folder, request, grid->size(), failed);
  };
  if (const auto status = on_first(ranks, gather)) return *status;
  return stopped ? interrupted : broken || ranks.any(failed > 0) ? not_finished : done;
}

}  // namespace windlass::app
