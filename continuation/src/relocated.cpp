#include "continuation/relocated.hpp"

#include <stdexcept>
#include <utility>

#include "continuation/branch_point.hpp"
#include "continuation/reduced.hpp"

namespace continuation {

namespace {

/// Newton's method on y(λ, 0) = 0.
std::optional<double> fold_near(Reduced& reduced, Vector p, Eigen::Index parameter) {
  constexpr int corrections = 2;
  for (int k = 0; k < corrections; ++k) {
    const auto here = reduced.at(p, Vector::Zero(1));
    if (!here || here->y_parameter(0, 0) == 0.0) return std::nullopt;
    p[parameter] -= here->y()[0] / here->y_parameter(0, 0);
  }
  return p[parameter];
}

/// One step of the secant method on tr y_α(λ, 0) = 0, from two places this far apart.
std::optional<double> multiple_point_near(Reduced& reduced, Vector p, Eigen::Index parameter, double apart) {
  const Vector still = Vector::Zero(reduced.null().right.cols());
  const auto here = reduced.at(p, still);
  const double at = p[parameter];
  p[parameter] += apart;
  const auto there = here ? reduced.at(p, still) : std::nullopt;
  if (!there) return std::nullopt;
  const Matrix change = there->y_alpha - here->y_alpha;
  const double slope = change.squaredNorm();
  if (slope == 0.0) return std::nullopt;
  return at - apart * change.cwiseProduct(here->y_alpha).sum() / slope;
}

}  // namespace

std::optional<double> relocated(Problem& problem, const Options& options, const Vector& x, const Vector& p,
                                PointType type, int multiplicity) {
  constexpr double near = 1e-3, apart = 1e-5;
  const Eigen::Index parameter = options.parameter;
  try {
    if (type == PointType::branch_point && multiplicity == 1) {
      std::string why;
      const auto point = branch_point_at(problem, options, x, p, near, why);
      return point ? std::optional(point->p[parameter]) : std::nullopt;
    }
    if (type != PointType::fold && type != PointType::branch_point) return std::nullopt;
    const int k = type == PointType::fold ? 1 : multiplicity;
    Reduced reduced(problem, options, x, p, null_vectors(problem, x, p, k, options), {parameter});
    return type == PointType::fold
               ? fold_near(reduced, p, parameter)
               : multiple_point_near(reduced, p, parameter, apart * options.parameter_scale);
  } catch (const std::domain_error&) {
  } catch (const std::runtime_error&) {
  }
  return std::nullopt;
}

}  // namespace continuation
