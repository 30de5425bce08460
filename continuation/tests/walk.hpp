#pragma once

#include <vector>

#include "continuation/walker.hpp"

namespace continuation::testing {

inline std::vector<Point> walk(Walker& walker) {
  std::vector<Point> points;
  while (auto point = walker.step()) points.push_back(std::move(*point));
  return points;
}

inline std::vector<Point> of_type(const std::vector<Point>& points, PointType type) {
  std::vector<Point> chosen;
  for (const Point& point : points) {
    if (point.type == type) chosen.push_back(point);
  }
  return chosen;
}

}  // namespace continuation::testing
