#include "windlass/output/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "windlass/output/error.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& doing, const fs::path& path, int error) {
  const std::string message =
      "cannot " + doing + " " + path.string() + ": " + std::generic_category().message(error);
  const bool device = error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO;
  if (device && doing != "read") throw DeviceError(message);
  throw OutputError(message);
}

/// write(2) until all is written. @return 0 or the errno
int write_all(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, data, size);
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

void replace_file(const fs::path& path, std::span<const char> bytes) {
  const fs::path temporary = path.string() + ".part";
  const int descriptor = ::open(temporary.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) fail("write", path, errno);
  int error = write_all(descriptor, bytes.data(), bytes.size());
  // close() is where some file systems report a full disk
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail("write", path, error);
  }
}

void replace_file(const fs::path& path, std::string_view text) {
  replace_file(path, std::span<const char>(text.data(), text.size()));
}

std::string read_file(const fs::path& path) {
  if (fs::is_directory(path)) fail("read", path, EISDIR);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("read", path, errno != 0 ? errno : EIO);
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) fail("read", path, EIO);
  return std::move(content).str();
}

AppendFile::AppendFile(fs::path path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("write", path_, errno);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendFile::append(std::string_view text) {
  const int error = write_all(descriptor_, text.data(), text.size());
  if (error != 0) fail("append to", path_, error);
}

}  // namespace windlass::output
