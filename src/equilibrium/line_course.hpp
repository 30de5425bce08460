#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "windlass/chain/profile.hpp"
#include "windlass/chain/topology.hpp"

/// How a line between two strands runs along them, and where touches are laid that stand for it (PHYSICS, "Lines between turns").
namespace windlass::equilibrium {

/// What is known of a line between two strands: of places along one of them those of the other and the pressure.
struct Touched {
  double s, other, pressure;  ///< pressure NaN: unknown
  bool mirrored;
};

/// Of all lines between strands.
std::vector<Touched> touched_by(const chain::Profile& profile, const chain::Topology& topology);

/// A line as a function of the place along the strand that is divided.
class Course {
 public:
  Course(const std::vector<Touched>& known, double begin, double other_begin, double end, double other_end,
         bool mirrored) {
    constexpr double near = 0.02;
    const auto [low, high] = std::minmax(other_begin, other_end);
    s_.push_back(begin), other_.push_back(other_begin);
    for (const Touched& t : known) {
      if (t.mirrored != mirrored || t.other < low - near || t.other > high + near) continue;
      if (t.s < begin - near || t.s > end + near) continue;
      if (!std::isnan(t.pressure)) at_.push_back(t.s), pressure_.push_back(t.pressure);
      const double sign = mirrored ? -1.0 : 1.0;  // an image runs the other way
      if (t.s > s_.back() && t.s < end && sign * (t.other - other_.back()) > 0.0 &&
          sign * (other_end - t.other) > 0.0)
        s_.push_back(t.s), other_.push_back(t.other);
    }
    s_.push_back(end), other_.push_back(other_end);
    if (!pressure_.empty()) least_ = 0.05 * *std::max_element(pressure_.begin(), pressure_.end());
  }

  double other(double s) const { return interpolated(s_, other_, s); }
  /// Where other(s) is that, between two places.
  double where(double other, double low, double high) const {
    const bool rises = this->other(high) > this->other(low);
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      ((this->other(middle) < other) == rises ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  double rate(double s) const {
    const auto after = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(s_.begin(), s_.end(), s) - s_.begin()), 1, s_.size() - 1);
    return (other_[after] - other_[after - 1]) / (s_[after] - s_[after - 1]);
  }
  bool pressed() const { return least_ > 0.0; }
  double pressure(double s) const { return least_ + interpolated(at_, pressure_, s); }
  /// Where a strand meets its own image.
  double meets_itself() const {
    for (std::size_t k = 1; k < s_.size(); ++k) {
      const double before = s_[k - 1] - other_[k - 1], after = s_[k] - other_[k];
      if (before <= 0.0 && after >= 0.0) return s_[k - 1] + (s_[k] - s_[k - 1]) * before / (before - after);
    }
    return 0.5 * (s_.front() + s_.back());
  }

 private:
  static double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto after = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    if (after == 0) return y.front();
    if (after == x.size()) return y.back();
    return y[after - 1] + (y[after] - y[after - 1]) * (at - x[after - 1]) / (x[after] - x[after - 1]);
  }
  std::vector<double> s_, other_, at_, pressure_;
  double least_ = 0.0;
};

/// What is at the two ends of a part of a line.
struct PartEnds {
  std::array<bool, 2> presses;  ///< a point force of something else, which goes on to this line
  std::array<bool, 2>
      touched;  ///< a touch of this line: the next one is a whole distance away, not half of one
};

/// Places between two, `begin` and `end` not among them.
/// @param finer  distances are divided by it; @param needed  increased by the links that it takes, as a real number
std::vector<double> laid_out(const Course& course, double begin, double end, const PartEnds& ends,
                             const chain::Profile& profile, double finer, double& needed);

}  // namespace windlass::equilibrium
