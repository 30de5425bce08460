#pragma once

#include <string>
#include <vector>

namespace windlass::app {

/// One direction of a sweep: a numeric scene key and its values, as one would write them after `--set KEY=`.
struct SweepAxis {
  std::string key;
  std::vector<std::string> values;
};

/// Reads "KEY=A:B:N", N equally spaced values from A to B; "KEY=A:B:N:log", N values of equal ratio; or the values
/// themselves, "KEY=A,B,C". Units as in a scene, e.g. "load.angle=1 pi:4 pi:7".
/// @throws InputError naming the word and what is allowed
SweepAxis parse_axis(const std::string& text);

/// All combinations of the axes' values; the last axis runs fastest.
class SweepGrid {
 public:
  /// @throws InputError for no axis, a key that stands twice, or more than a million cases
  explicit SweepGrid(std::vector<SweepAxis> axes);
  const std::vector<SweepAxis>& axes() const { return axes_; }
  int size() const { return size_; }
  /// One value an axis. @param number  from 0
  std::vector<std::string> values(int number) const;
  /// The case as words for `--set`: KEY=VALUE, one an axis.
  std::vector<std::string> settings(int number) const;

 private:
  std::vector<SweepAxis> axes_;
  int size_ = 1;
};

}  // namespace windlass::app
