#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include "windlass/knot/start_curve.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::knot {

using Eigen::Vector3d;

namespace {

double number(std::string_view cell, const std::string& place) {
  const auto first = cell.find_first_not_of(" \t\r"), last = cell.find_last_not_of(" \t\r");
  double value = NAN;
  if (first != std::string_view::npos) {
    cell = cell.substr(first, last - first + 1);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)) return value;
  }
  throw InputError(fmt::format("{}: \"{}\": must be a number", place, cell));
}

Curve read_points(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("knot.curve = \"{}\": cannot be read", path.string()));
  Curve points;
  std::string line;
  for (int n = 1; std::getline(file, line); ++n) {
    const bool heading = points.empty() && line.find('x') != std::string::npos;
    if (heading || line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    Vector3d point;
    std::string_view rest = line;
    for (int k = 0; k < 3; ++k) {
      const auto comma = rest.find(',');
      const bool last = k == 2;
      if ((comma == std::string_view::npos) != last)
        throw InputError(fmt::format("{}:{}: must be three numbers x, y, z", path.string(), n));
      point(k) = number(rest.substr(0, comma), fmt::format("{}:{}: column {}", path.string(), n, k + 1));
      if (!last) rest.remove_prefix(comma + 1);
    }
    points.push_back(point);
  }
  return points;
}

double distance(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const Vector3d along = b - a;
  const double part = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (a + part * along - p).norm();
}

std::vector<double> lengths(const Curve& points) {
  std::vector<double> s = {0.0};
  for (std::size_t k = 1; k < points.size(); ++k) s.push_back(s.back() + (points[k] - points[k - 1]).norm());
  return s;
}

Vector3d at(const Curve& points, const std::vector<double>& s, double place) {
  std::size_t k = 1;
  while (k + 1 < s.size() && s[k] < place) ++k;
  return points[k - 1] + (place - s[k - 1]) / (s[k] - s[k - 1]) * (points[k] - points[k - 1]);
}

/// Distance from a place to what of the curve is farther from it along the curve than `apart`.
double nearest_strand(const Curve& points, const std::vector<double>& s, double place, double apart) {
  const Vector3d here = at(points, s, place);
  double nearest = HUGE_VAL;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double begin = std::max(s[i - 1], place + apart), end = std::min(s[i], place - apart);
    if (begin < s[i]) nearest = std::min(nearest, distance(at(points, s, begin), points[i], here));
    if (end > s[i - 1]) nearest = std::min(nearest, distance(points[i - 1], at(points, s, end), here));
  }
  return nearest;
}

}  // namespace

Curve read_curve(const std::filesystem::path& path, const Bounds& bounds) {
  const auto refuse = [&](const std::string& why) {
    return InputError(fmt::format("knot.curve = \"{}\": {}", path.string(), why));
  };
  const Curve points = read_points(path);
  constexpr std::size_t fewest = 9;
  if (points.size() < fewest)
    throw refuse(fmt::format("has {} points; must have {} or more", points.size(), fewest));
  const std::vector<double> s = lengths(points);
  for (std::size_t k = 1; k < s.size(); ++k)
    if (s[k] == s[k - 1]) throw refuse(fmt::format("points {} and {} are the same", k, k + 1));
  if (s.back() > bounds.length)
    throw refuse(fmt::format("is {:g} long; the rod (rod.length) must be as long, and is {:g}", s.back(),
                             bounds.length));
  const double middle = 0.5 * s.back();
  constexpr int samples = 200;
  const double same = 0.02 * (bounds.cylinder ? 1.0 : 0.1 * s.back());  // of the knot: drawn by hand
  for (int k = 0; k <= samples; ++k) {
    const double beyond = middle * k / samples;
    const Vector3d a = at(points, s, middle + beyond), b = at(points, s, middle - beyond);
    if ((a - Vector3d(-b(0), b(1), -b(2))).norm() > same)
      throw refuse(
          fmt::format("must be its own image under the half-turn about e_y, (x, y, z) to (-x, y, -z): {:g} "
                      "from its middle it is off by {:.2g}",
                      beyond, (a - Vector3d(-b(0), b(1), -b(2))).norm()));
    if (bounds.cylinder && a.head<2>().norm() < 1.0 - bounds.radius)
      throw refuse(fmt::format("passes through the cylinder, {:g} from its middle", beyond));
    if (nearest_strand(points, s, middle + beyond, M_PI * bounds.radius) < bounds.radius)
      throw refuse(fmt::format(
          "penetrates itself: {:g} from its middle another strand is nearer than rod.radius", beyond));
  }
  Curve half = {at(points, s, middle)};
  for (std::size_t k = 0; k < points.size(); ++k)
    if (s[k] > middle * (1.0 + 1e-9)) half.push_back(points[k]);
  half.front()(0) = half.front()(2) = 0.0;
  return half;
}

Curve start_curve(const scene::Scene& scene) {
  if (scene.knot.curve.empty()) return clove_hitch(scene.rod_radius);
  const double unit = scene.solved_in.length;
  Curve curve =
      read_curve(scene.knot.curve, {unit * scene.rod_radius, unit * scene.rod.length, scene.has_cylinder});
  for (Vector3d& corner : curve) corner /= unit;
  return curve;
}

}  // namespace windlass::knot
