#include "continuation/branch_switch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "continuation/bifurcation_rays.hpp"

namespace continuation {

bool same_fingerprint(const Vector& a, const Vector& b, double tolerance, double unit) {
  if (a.size() != b.size()) return false;
  const double n = std::max<double>(1.0, static_cast<double>(a.size()));
  return (a - b).norm() <= tolerance * std::max(unit * std::sqrt(n), a.norm());
}

std::optional<Arm> start_arm(const Point& branch_point, const Tangent& direction, double epsilon,
                             const Options& options, ArmFailure& failure) {
  const Scales scale = options.scales();
  try {
    Arm arm;
    arm.problem = branch_point.problem->clone();
    Options patient = options;
    patient.max_newton = std::max(options.max_newton, 15);
    Segment segment(arm.problem, patient, branch_point.x, branch_point.p, direction);
    Sample* sample = segment.at(epsilon, true);
    if (!sample) return failure = {segment.failure()}, std::nullopt;
    const Tangent way{sample->it.u, sample->it.y[0]};
    const double length = std::sqrt(inner(*arm.problem, way, way, scale));
    const double along = std::abs(inner(*arm.problem, way, direction, scale)) / length;
    const double known = std::abs(inner(*arm.problem, way, branch_point.tangent, scale)) / length;
    // An arm that breaks a symmetry leaves at a right angle to the branch, whose tangent rounding turns towards it here.
    const bool tells = branch_point.branch_point && !branch_point.breaking;
    if (along < 0.8 || (tells && along <= known))
      return failure = {"the solution found is not on the arm"}, std::nullopt;
    segment.add_events(*sample);
    for (const EventFunction& event : sample->events) {
      if (event.value < -options.event_zero)
        return failure = {"event " + event.name + " is negative on it", true}, std::nullopt;
    }
    arm.x = sample->it.x;
    arm.p = sample->it.p;
    arm.tangent = sample->tangent;
    arm.epsilon = epsilon;
    return arm;
  } catch (const std::domain_error& error) {
    failure = {error.what()};
  } catch (const std::runtime_error& error) {
    failure = {error.what()};
  }
  return std::nullopt;
}

namespace {

/// Ways that leave a branch point; one that leads away both ways stands once, unless all of them are rays.
struct Directions {
  std::vector<Tangent> list;
  bool rays = false;
};

Directions directions_from(const Point& at, const Options& options) {
  Directions directions;
  Problem& problem = *at.problem;
  // By the symmetry that is broken arms leave along the kernel. (Next to a fold, where the branch hardly answers to p, the
  // quadratic terms that tell two tangents apart have few digits.)
  const bool pitchfork = at.breaking && at.branch_point && at.branch_point->null.right.cols() == 1;
  if (!pitchfork && at.branch_point && at.branch_point->tangents.size() == 2) {
    directions.list.push_back(at.branch_point->tangents[1]);
  } else {
    const Matrix kernel =
        at.branch_point ? at.branch_point->null.right
                        : null_vectors(problem, at.x, at.p, std::max(1, at.multiplicity), options).right;
    std::vector<Vector> named = problem.kernel_directions(at.x, at.p, kernel);
    if (named.empty() && kernel.cols() == 2) directions.list = bifurcation_rays(problem, options, at.x, at.p);
    directions.rays = !directions.list.empty();
    if (named.empty() && !directions.rays)
      for (Eigen::Index i = 0; i < kernel.cols(); ++i) named.emplace_back(kernel.col(i));
    for (Vector& d : named) directions.list.push_back(Tangent{std::move(d), 0.0});
  }
  for (Tangent& direction : directions.list) normalise(problem, direction, options.scales());
  return directions;
}

}  // namespace

Arms switch_branch(const Point& branch_point, const Options& options) {
  Arms arms;
  Directions found;
  try {
    found = directions_from(branch_point, options);
  } catch (const std::domain_error& error) {
    arms.failures.emplace_back(error.what());
  } catch (const std::runtime_error& error) {
    arms.failures.emplace_back(error.what());
  }
  const std::vector<Tangent>& directions = found.list;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (const int sign : {1, -1}) {
      if (found.rays && sign < 0) continue;
      const Tangent direction{sign * directions[i].x, sign * directions[i].p};
      std::optional<Arm> arm;
      ArmFailure failure;
      for (const double part : {0.2, 0.05, 0.5, 0.01, 1e-3}) {
        arm = start_arm(branch_point, direction, part * options.step, options, failure);
        if (arm) break;
      }
      if (!arm && !failure.inadmissible) {
        const std::string held = branch_point.problem->unsettled(branch_point.x, direction.x);
        if (!held.empty()) failure = {held, true};
      }
      if (!arm) {
        auto& list = failure.inadmissible ? arms.inadmissible : arms.failures;
        list.push_back("direction " + std::to_string(i + 1) + (sign > 0 ? " (+): " : " (-): ") +
                       failure.reason);
        continue;
      }
      const Vector fingerprint = arm->problem->fingerprint(arm->x, arm->p);
      const auto twin = std::find_if(arms.arms.begin(), arms.arms.end(), [&](const Arm& other) {
        return other.epsilon == arm->epsilon &&
               same_fingerprint(other.p, arm->p, 1e-7, options.parameter_scale) &&
               same_fingerprint(other.problem->fingerprint(other.x, other.p), fingerprint, 1e-7,
                                options.state_scale);
      });
      if (twin == arms.arms.end()) {
        arms.arms.push_back(std::move(*arm));
      } else {
        ++twin->count;
      }
    }
  }
  return arms;
}

}  // namespace continuation
