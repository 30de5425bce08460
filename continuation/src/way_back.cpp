#include "way_back.hpp"

#include <algorithm>
#include <utility>

namespace continuation {

namespace {

Options turned(Options options) {
  options.target = options.direction > 0 ? options.lower : options.upper;
  options.direction = -options.direction;
  return options;
}

bool is_located(const Point& point) {
  return point.type != PointType::start && point.type != PointType::regular && point.type != PointType::end;
}

}  // namespace

WayBack::WayBack(const Arm& start, const Options& options)
    : walker_(start.problem->clone(), start.x, start.p, turned(options)) {}

const Point* WayBack::step() {
  std::optional<Point> point = walker_.step();
  if (!point) return nullptr;
  if (!is_located(*point)) point->problem = point->problem->clone();  // which goes on
  points_.push_back(std::move(*point));
  return &points_.back();
}

std::vector<Point> WayBack::reversed() {
  std::vector<Point> out = std::move(points_);
  // Path lengths since the point before become those to the one that follows.
  for (std::size_t k = 0; k + 1 < out.size(); ++k) out[k].ds = out[k + 1].path_length - out[k].path_length;
  if (!out.empty()) out.back().ds = 0.0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    Point& point = out[k];
    point.path_length = -point.path_length;
    point.tangent = Tangent{-point.tangent.x, -point.tangent.p};
    std::swap(point.index, point.index_after);
    std::swap(point.before, point.after);
    point.bracket_lo = -std::exchange(point.bracket_hi, -point.bracket_lo);
    if (!is_located(point)) point.type = PointType::regular;
    if (point.type != PointType::event || k == 0) continue;
    const Point& behind = out[k - 1];
    point.next_problem = behind.problem, point.next_x = behind.x, point.next_p = behind.p;
  }
  std::reverse(out.begin(), out.end());
  if (!out.empty() && !is_located(out.front())) out.front().type = PointType::start;
  return out;
}

}  // namespace continuation
