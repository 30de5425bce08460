#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace windlass::output {

/// Replaces `path` by `bytes` so that a reader sees either the old content or the new, never a mixture:
/// writes a temporary file beside it, then renames. The old content survives a full disk and a kill.
/// @throws OutputError naming the file and the system's reason
void replace_file(const std::filesystem::path& path, std::span<const char> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

/// Whole content of a file. @throws OutputError naming the file and the system's reason
std::string read_file(const std::filesystem::path& path);

/// Move-only owner of a file opened for appending; each append is one write call, so a killed process
/// leaves at most one incomplete last line.
class AppendFile {
 public:
  AppendFile() = default;
  /// @throws OutputError when the file cannot be opened for appending
  explicit AppendFile(std::filesystem::path path);
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;
  ~AppendFile();

  /// @throws OutputError, e.g. on a full disk; what was appended before is intact
  void append(std::string_view text);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace windlass::output
