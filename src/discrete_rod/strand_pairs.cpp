#include "windlass/discrete_rod/strand_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace windlass::discrete_rod {

using Point = SplineRod::Point;

const std::array<double, 4> Quadrature::place = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                                 0.9305681557970263};
const std::array<double, 4> Quadrature::weight = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                                  0.1739274225687269};

namespace {

/// Elements of the whole rod by the cell that holds their middle.
class CellList {
 public:
  CellList(const std::vector<Point>& middles, int first, double size) : size_(size) {
    for (std::size_t k = 0; k < middles.size(); ++k)
      cells_[key(cell(middles[k]))].push_back(first + static_cast<int>(k));
  }

  /// Elements in the 27 cells about `at`, in order along the rod.
  void near(const Point& at, std::vector<int>& out) const {
    out.clear();
    const Eigen::Vector3i middle = cell(at);
    for (int k = 0; k < 27; ++k) {
      const auto found = cells_.find(key(middle + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found != cells_.end()) out.insert(out.end(), found->second.begin(), found->second.end());
    }
    std::sort(out.begin(), out.end());
  }

 private:
  Eigen::Vector3i cell(const Point& at) const { return (at / size_).array().floor().cast<int>(); }
  static std::int64_t key(const Eigen::Vector3i& c) {
    constexpr std::int64_t width = 1 << 20;
    return (c(0) * width + c(1)) * width + c(2);
  }

  double size_;
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

/// Minimum of the distance from `at` to one element; none where that lies on an end.
std::optional<double> foot(const SplineRod::Controls& controls, const Point& at) {
  double t = 0.5;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Point gap = controls * cubic_weights(t, 0) - at, slope = controls * cubic_weights(t, 1),
                curvature = controls * cubic_weights(t, 2);
    const double first = gap.dot(slope), second = slope.squaredNorm() + gap.dot(curvature);
    const double step = second > 0.0 ? -first / second : (first > 0.0 ? -0.5 : 0.5);
    const double next = std::clamp(t + step, -0.5, 1.5);
    // Newton's next step would be the square of this one. Steps at rounding need not become smaller than they
    // are: a foot that was lost for that made the energy jump.
    const bool settled = std::abs(next - t) < 1e-9;
    t = next;
    if (!settled) continue;
    // Half open, so that of two neighbours one has the foot.
    return second > 0.0 && t >= 0.0 && t < 1.0 ? std::optional(t) : std::nullopt;
  }
  return std::nullopt;
}

/// Elements from `begin` to `end`, first places on those from `first` on.
template <class Rod>
std::vector<StrandPair> pairs_of(const Rod& rod, const SplineRod::Vector& x, int begin, int first, int end,
                                 double reach, double apart) {
  std::vector<Point> middles;
  double longest = 0.0;
  for (int e = begin; e < end; ++e) {
    middles.push_back(rod.position(x, e, 0.5));
    longest = std::max(longest, rod.length(e));
  }
  const CellList cells(middles, begin, reach + longest);
  std::vector<StrandPair> out;
  std::vector<int> candidates;
  for (int e = first; e < end; ++e)
    for (int q = 0; q < Quadrature::points; ++q) {
      const double t = Quadrature::place[q], s = rod.knot(e) + t * rod.length(e);
      const Point at = rod.position(x, e, t);
      cells.near(at, candidates);
      for (const int other : candidates) {
        if (other == e ||
            std::abs(rod.knot(other) + 0.5 * rod.length(other) - s) < apart - 0.5 * rod.length(other))
          continue;
        if ((middles[other - begin] - at).norm() > reach + rod.length(other)) continue;
        const auto controls = rod.controls(x, other);
        const auto at_foot = foot(controls, at);
        if (!at_foot || std::abs(rod.knot(other) + *at_foot * rod.length(other) - s) < apart) continue;
        const double distance = (controls * cubic_weights(*at_foot, 0) - at).norm();
        if (distance < reach)
          out.push_back({e, other, t, *at_foot, Quadrature::weight[q] * rod.length(e), distance});
      }
    }
  return out;
}

}  // namespace

std::vector<StrandPair> strand_pairs(const SplineRod& rod, const SplineRod::Vector& x, double reach,
                                     double apart) {
  return pairs_of(rod, x, -rod.elements(), 0, rod.elements(), reach, apart);
}

std::vector<StrandPair> strand_pairs(const OpenSpline& rod, const OpenSpline::Vector& x, double reach,
                                     double apart) {
  return pairs_of(rod, x, 0, 0, rod.elements(), reach, apart);
}

}  // namespace windlass::discrete_rod
