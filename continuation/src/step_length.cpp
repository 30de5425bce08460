#include "continuation/step_length.hpp"

#include <algorithm>
#include <cmath>

namespace continuation {

StepLength::StepLength(const Options& options)
    : step_(options.step),
      step_min_(options.step_min),
      step_max_(options.step_max),
      target_contraction_(options.target_contraction),
      target_newton_(options.target_newton) {}

StepLength::StepLength(const Options& options, double current, double usual, bool after_rejection)
    : StepLength(options) {
  step_ = current;
  usual_ = usual;
  after_rejection_ = after_rejection;
}

void StepLength::accepted(int iterations, double contraction) {
  double factor = std::exp2(0.5 * (target_newton_ - iterations));
  if (contraction > 0.0) factor = std::min(factor, std::sqrt(target_contraction_ / contraction));
  factor = std::clamp(factor, 0.5, after_rejection_ ? 1.0 : 2.0);
  after_rejection_ = false;
  set(step_ * factor);
  if (step_ >= usual_) usual_ = 0.0;
}

bool StepLength::rejected() {
  if (0.5 * step_ < step_min_) return false;
  usual_ = usual();
  step_ *= 0.5;
  after_rejection_ = true;
  return true;
}

void StepLength::reset(double step) {
  set(step);
  usual_ = 0.0;
}

void StepLength::set(double step) { step_ = std::clamp(step, step_min_, step_max_); }

}  // namespace continuation
