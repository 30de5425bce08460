#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "windlass/verify/certificate.hpp"

namespace windlass::verify {

/// Largest value seen; a value that is not finite is kept, so that it cannot slip through std::max.
class Largest {
 public:
  void add(double value) {
    any_ = true;
    if (std::isnan(value_)) return;
    value_ = std::isnan(value) ? value : std::max(value_, value);
  }
  double value() const { return value_; }
  bool any() const { return any_; }

 private:
  double value_ = 0.0;
  bool any_ = false;
};

/// Smallest value seen, NaN kept; +infinity when there was none.
class Smallest {
 public:
  void add(double value) {
    if (std::isnan(value_)) return;
    value_ = std::isnan(value) ? value : std::min(value_, value);
    any_ = true;
  }
  bool any() const { return any_; }
  double value() const { return value_; }

 private:
  double value_ = HUGE_VAL;
  bool any_ = false;
};

/// The bounds in the checks are for the usual standard; a looser or stricter one scales them all.
class CheckList {
 public:
  explicit CheckList(const Standard& standard) : scale_(standard.accept / Standard{}.accept) {}

  void at_most(std::string name, double value, double bound, std::string meaning) {
    certificate_.checks.push_back(
        {std::move(name), value, scale_ * bound, Sense::at_most, std::move(meaning)});
  }
  void at_least(std::string name, double value, double bound, std::string meaning) {
    certificate_.checks.push_back(
        {std::move(name), value, scale_ * bound, Sense::at_least, std::move(meaning)});
  }
  Certificate take() { return std::move(certificate_); }

 private:
  double scale_;
  Certificate certificate_;
};

/// What everything is measured against.
struct Scales {
  double force = 1.0;   ///< max(1, T), or max(1, end force) of a strut
  double moment = 1.0;  ///< √force: moments and curvatures of a rod under T grow like √T
  double tolerance = Standard{}.tolerance;  ///< of the reference integration
};

}  // namespace windlass::verify
