#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "windlass/output/folder_lock.hpp"
#include "windlass/pull/pull.hpp"

namespace windlass::app {

/// The steps of a pull on one mesh.
struct PulledMesh {
  double h = 0.0;  ///< length of the elements near the coil [ρ]
  std::vector<pull::Row> rows;
};

/// Where a pull lives on disk: scene.toml; pull.json says what is pulled and, once it is over, what came out; pull.csv has
/// a row a step; pull.cbor, while it is not over, is what --resume goes on from. Files are replaced whole.
class PullFolder {
 public:
  /// @param request  all that decides what the pull will hold, JSON text
  /// @param force    unit of force in which the table is written [EI/ρ²]
  PullFolder(std::filesystem::path folder, std::string request, double force)
      : folder_(std::move(folder)), request_(std::move(request)), force_(force) {}

  enum class Found { nothing, begun, over };
  /// Makes the folder, or with `resume` checks that it holds this pull.
  /// @throws InputError for a folder in use or another pull's; output::OutputError
  Found prepare(const std::string& scene, bool force, bool resume);

  struct Checkpoint {
    std::vector<PulledMesh> meshes;    ///< the last one is not over
    std::optional<pull::State> state;  ///< of the last one; empty: to be started
  };
  /// nullopt where nothing was saved. @throws output::OutputError when it is damaged
  std::optional<Checkpoint> read() const;
  /// Table and checkpoint. @throws output::OutputError
  void save(std::span<const PulledMesh> meshes, const pull::State* state) const;
  /// Table and outcome; the checkpoint is gone. @throws output::OutputError
  void finish(std::span<const PulledMesh> meshes, const nlohmann::ordered_json& outcome) const;
  /// What finish() stored.
  nlohmann::ordered_json outcome() const;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::string table(std::span<const PulledMesh> meshes) const;

  std::filesystem::path folder_;
  std::string request_;
  double force_;
  output::FolderLock lock_;
};

}  // namespace windlass::app
