#include "windlass/measurement/friction_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "windlass/scene/error.hpp"

namespace windlass::measurement {

namespace {

/// √w of a point.
double root_weight(const ComparedPoint& point, Weights weights, bool errors_given) {
  if (errors_given) return 1.0 / *point.measured.F0_error;
  return weights == Weights::relative ? 1.0 / point.R_tot : 1.0;
}

}  // namespace

FrictionFit fit_friction(std::span<const ComparedPoint> points, Weights weights) {
  namespace math = boost::math;
  if (points.size() < 2)
    throw InputError("the fit needs at least two measured points; there are " +
                     std::to_string(points.size()));
  FrictionFit fit;
  fit.errors_given = weights == Weights::automatic &&
                     std::all_of(points.begin(), points.end(),
                                 [](const auto& p) { return p.measured.F0_error.has_value(); });
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd design(count, 1);
  Eigen::VectorXd observed(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ComparedPoint& point = points[static_cast<std::size_t>(i)];
    const double w = root_weight(point, weights, fit.errors_given);
    design(i, 0) = w * point.R_tot;
    observed[i] = w * point.measured.F0;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  fit.mu = qr.solve(observed)[0];
  fit.chi_squared = (observed - design * fit.mu).squaredNorm();
  fit.degrees_of_freedom = static_cast<int>(count) - 1;
  fit.residual_deviation = std::sqrt(fit.chi_squared / fit.degrees_of_freedom);
  // (AᵀA)⁻¹ = (RᵀR)⁻¹ is the variance of mu for observations of variance 1.
  fit.standard_error = (fit.errors_given ? 1.0 : fit.residual_deviation) / std::abs(qr.matrixR()(0, 0));
  constexpr double upper_tail = 0.975;
  const double factor = fit.errors_given
                            ? math::quantile(math::normal(), upper_tail)
                            : math::quantile(math::students_t(fit.degrees_of_freedom), upper_tail);
  fit.low = fit.mu - factor * fit.standard_error;
  fit.high = fit.mu + factor * fit.standard_error;
  if (fit.errors_given)
    fit.p_value = math::cdf(math::complement(math::chi_squared(fit.degrees_of_freedom), fit.chi_squared));
  for (const ComparedPoint& point : points) fit.residuals.push_back(point.measured.F0 - fit.mu * point.R_tot);
  return fit;
}

}  // namespace windlass::measurement
