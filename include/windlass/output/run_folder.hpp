#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/folder_lock.hpp"
#include "windlass/output/point_store.hpp"
#include "windlass/output/records.hpp"
#include "windlass/scene/scene.hpp"

/// The run folder: scene.toml, run.json, branches.csv, special_points.json, points.h5; checkpoint.cbor while a run that
/// can be gone on with is not over.
///
/// One process at a time may write there (FolderLock). Every file has a checksum: points.h5, checkpoint.cbor and
/// run.json their own, the others in run.json; what does not fit is refused as damaged, unread.
///
/// At every moment, also after SIGKILL or a full disk, the folder is readable. branches.csv grows by one write
/// a row; the other files are replaced whole (temporary file + rename). points.h5 is replaced when a special point is
/// recorded, at the end, and otherwise once a second, all of it more seldom where writing would take more than 5 % of
/// the run: a kill loses at most that last stretch, of special_points.json too.
namespace windlass::output {

struct WriterOptions {
  bool force = false;  ///< replace the run in an existing folder (foreign files are kept)
  std::string command = "continue";
  std::string version = "unknown";
  std::string parameter;        ///< dotted key the branches are followed in; empty: none
  std::string extra_parameter;  ///< dotted key that gets its own, last CSV column; empty: none
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  /// Longest time between two commits [s]; 0: at every point. Empty: a second, more where writing takes longer.
  std::optional<double> save_every;
};

/// How much of a run's lists a checkpoint knows of; what a killed run stored beyond it is computed again.
struct Extent {
  std::size_t points = 0, special_points = 0, lost_branches = 0;
};

/// What a run goes on from. `state` is the business of who computes the run.
struct Checkpoint {
  Extent extent;
  nlohmann::json state;
};

/// @return nullopt where there is none. @throws OutputError when it is unreadable or damaged
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& folder);

class RunWriter {
 public:
  /// Makes the folder (parents too) and its first files; a new folder appears under its name when they are complete.
  /// @throws OutputError when it holds something and force is false, or cannot be written
  static RunWriter create(const std::filesystem::path& folder, const scene::Scene& scene,
                          const WriterOptions& options);
  /// Opens a stored run to go on. Rows and special points whose solution was not stored are dropped, and so is what
  /// lies beyond `extent`.
  /// @throws OutputError when the folder cannot be read or written, or holds less than the extent
  static RunWriter resume(const std::filesystem::path& folder,
                          const std::optional<Extent>& extent = std::nullopt,
                          std::optional<double> save_every = std::nullopt);

  /// Rows are on disk on return; the solution at the next commit. @throws OutputError
  void add_point(const BranchRow& row, const equilibrium::Solution& solution);
  /// Listed on disk at the next commit, which comes now unless commits take too much of the run's time. @throws OutputError
  void add_special_point(const SpecialPoint& point);
  void add_lost_branch(const LostBranch& lost);
  /// Gives a point that exists on disk its index and eigenvalues (branches.csv and points.h5).
  void set_stability(const std::string& name, const equilibrium::Stability& stability);
  /// Writes points.h5 and run.json now. @throws OutputError
  void commit();
  /// Time for the next checkpoint.
  bool checkpoint_due() const { return std::chrono::steady_clock::now() - last_checkpoint_ >= pause_; }
  /// Commits, then stores what the run can be gone on from. The order makes a kill in between harmless: a checkpoint
  /// never knows more than the other files. @throws OutputError
  void checkpoint(nlohmann::json state);
  /// Final commit with status "finished", "interrupted" or "incomplete"; only an interrupted run keeps its checkpoint.
  /// @throws OutputError
  void finish(const std::string& status, const Timings& timings, nlohmann::ordered_json summary);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<BranchRow>& rows() const { return rows_; }
  const std::vector<SpecialPoint>& special_points() const { return special_points_; }
  const PointStore& points() const { return store_; }
  RunInfo& info() { return info_; }

 private:
  RunWriter() = default;
  void set_pause();
  /// Replaces a file whose checksum stands in run.json, which knows the new one first.
  void replace_stamped(const char* file, const std::string& text);
  void rewrite_branches();
  void write_special_points();
  void write_stale();
  void write_info();

  std::filesystem::path folder_;
  FolderLock lock_;
  RunInfo info_;
  AppendFile branches_;
  std::string branches_text_;  ///< content of branches.csv
  std::vector<BranchRow> rows_;
  std::vector<SpecialPoint> special_points_;
  PointStore store_;
  std::size_t committed_ = 0;
  bool rows_stale_ = false;     ///< rows_ holds what branches.csv does not
  bool special_stale_ = false;  ///< special_points_ holds what special_points.json does not
  bool started_ = false;        ///< run.json is on disk
  std::optional<double> save_every_;
  std::chrono::steady_clock::time_point last_commit_{}, last_checkpoint_{};
  std::chrono::duration<double> commit_takes_{0.0}, checkpoint_takes_{0.0};  ///< the last one, itself
  std::chrono::duration<double> pause_{1.0};
  std::chrono::duration<double> special_pause_{0.0};  ///< between commits for a special point's sake
};

/// Everything a run folder holds.
struct Run {
  std::filesystem::path folder;
  std::string scene_toml;
  RunInfo info;
  std::vector<BranchRow> rows;
  std::vector<SpecialPoint> special_points;
  PointStore points;

  /// Row of a stored point by label or "BRANCH-POINT". @throws OutputError when there is none
  const BranchRow& row(const std::string& name) const;
};

/// @throws OutputError naming the file that is missing, unreadable or damaged
Run read_run(const std::filesystem::path& folder, bool with_points = true);

}  // namespace windlass::output
