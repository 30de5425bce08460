#pragma once

#include <vector>

#include "continuation/branch_switch.hpp"
#include "continuation/walker.hpp"

namespace continuation {

/// A branch from a start inside it back to the bound behind it, and what was met as a walk from there would meet it.
class WayBack {
 public:
  WayBack(const Arm& start, const Options& options);

  /// The next point; nullptr at the end.
  const Point* step();
  const End& end() const { return walker_.end(); }
  /// From the far end to the start. Path lengths are negative: they count from the start.
  std::vector<Point> reversed();

 private:
  Walker walker_;
  std::vector<Point> points_;
};

}  // namespace continuation
