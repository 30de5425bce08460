#include "windlass/measurement/dragged_fit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace windlass::measurement {

namespace {

/// F0 at all points.
std::vector<double> strengths(std::size_t count, double friction, const Strength& strength) {
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> force = strength(i, friction);
    if (!force)
      throw std::runtime_error(
          fmt::format("the fit lost the dragged state of a measured point at mu = {:.6g}", friction));
    all.push_back(*force);
  }
  return all;
}

}  // namespace

FrictionFit fit_dragged(std::span<ComparedPoint> points, Weights weights, double start,
                        const Strength& strength) {
  constexpr int most = 20;
  constexpr double beside = 1e-4, settled = 1e-10;  // of mu: differences err by some 1e-8 of the slope
  double mu = start;
  for (int iteration = 0; iteration < most; ++iteration) {
    const std::vector<double> here = strengths(points.size(), mu, strength),
                              above = strengths(points.size(), mu * (1.0 + beside), strength),
                              below = strengths(points.size(), mu * (1.0 - beside), strength);
    std::vector<ComparedPoint> linear(points.begin(), points.end());
    for (std::size_t i = 0; i < linear.size(); ++i) {
      linear[i].R_tot = (above[i] - below[i]) / (2.0 * beside * mu);
      linear[i].measured.F0 += linear[i].R_tot * mu - here[i];
    }
    FrictionFit fit = fit_friction(linear, weights);
    const double change = fit.mu - mu;
    if (std::abs(change) <= settled * mu) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].R_tot = here[i] / mu;
        fit.residuals[i] = points[i].measured.F0 - here[i];
      }
      return fit;
    }
    mu = fit.mu > 0.0 ? fit.mu : 0.5 * mu;
  }
  throw std::runtime_error("the friction coefficient did not settle");
}

}  // namespace windlass::measurement
