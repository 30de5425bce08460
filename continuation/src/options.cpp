#include "continuation/options.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace continuation {
namespace {

template <class Value>
void require(bool holds, const char* bound, Value value) {
  if (holds) return;
  std::ostringstream message;
  message << "continuation options: " << bound << " is violated, the value is " << value;
  throw std::invalid_argument(message.str());
}

}  // namespace

void Options::validate() const {
  require(parameter >= 0, "parameter >= 0", parameter);
  require(direction == 1 || direction == -1, "direction = 1 or -1", direction);
  require(lower < upper, "lower < upper", lower);
  require(step_min > 0.0, "step_min > 0", step_min);
  require(step >= step_min, "step >= step_min", step);
  require(step <= step_max, "step <= step_max", step);
  require(std::isfinite(step_max), "step_max < infinity", step_max);
  require(parameter_scale > 0.0 && std::isfinite(parameter_scale), "parameter_scale > 0", parameter_scale);
  require(state_scale > 0.0 && std::isfinite(state_scale), "state_scale > 0", state_scale);
  require(residual_scale > 0.0 && std::isfinite(residual_scale), "residual_scale > 0", residual_scale);
  for (const UserFunction& function : functions)
    require(static_cast<bool>(function.value), "a function to call", function.name);
  require(max_points >= 1, "max_points >= 1", max_points);
  require(max_angle > 0.0 && max_angle < 1.5707963267948966, "0 < max_angle < pi/2", max_angle);
  require(newton_tolerance > 0.0 && newton_tolerance < 1.0, "0 < newton_tolerance < 1", newton_tolerance);
  require(residual_tolerance > 0.0, "residual_tolerance > 0", residual_tolerance);
  require(max_newton >= 1, "max_newton >= 1", max_newton);
  require(target_newton >= 1, "target_newton >= 1", target_newton);
  require(target_newton <= max_newton, "target_newton <= max_newton", target_newton);
  require(target_contraction > 0.0 && target_contraction < 1.0, "0 < target_contraction < 1",
          target_contraction);
  require(location_tolerance > 0.0, "location_tolerance > 0", location_tolerance);
  require(event_zero >= 0.0, "event_zero >= 0", event_zero);
}

}  // namespace continuation
