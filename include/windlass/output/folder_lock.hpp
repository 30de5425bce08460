#pragma once

#include <filesystem>

namespace windlass::output {

/// Keeps other processes of the program from writing to a folder while it lives. The lock is the system's (flock on the
/// folder itself): it leaves no file, follows the folder when it is renamed, and is gone with a killed process.
class FolderLock {
 public:
  FolderLock() = default;
  /// @throws OutputError when another process holds it. A file system without locks does without.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  int descriptor_ = -1;
};

}  // namespace windlass::output
